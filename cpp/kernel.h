// What every part of the bridge computes with.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "rust/cxx.h"

namespace walpha {

// Exact predicates decide every combinatorial question; the bridge reads no constructed number.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Points of space with their numbers, as CGAL inserts them with info.
template <typename Weighted_point>
std::vector<std::pair<Weighted_point, std::uint32_t>> numbered(
    rust::Slice<const double> positions, rust::Slice<const double> weights) {
  std::vector<std::pair<Weighted_point, std::uint32_t>> points;
  points.reserve(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double *p = positions.data() + 3 * i;
    points.emplace_back(Weighted_point({p[0], p[1], p[2]}, weights[i]),
                        static_cast<std::uint32_t>(i));
  }
  return points;
}

}  // namespace walpha
