// Input points as CGAL takes them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "rust/cxx.h"

namespace walpha {

// Weighted points with their indices, for a triangulation whose vertices hold such an index.
template <typename Triangulation>
std::vector<std::pair<typename Triangulation::Weighted_point, std::uint32_t>> numbered(
    rust::Slice<const double> positions, rust::Slice<const double> weights) {
  std::vector<std::pair<typename Triangulation::Weighted_point, std::uint32_t>> points;
  points.reserve(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double *p = positions.data() + 3 * i;
    points.emplace_back(typename Triangulation::Weighted_point({p[0], p[1], p[2]}, weights[i]),
                        static_cast<std::uint32_t>(i));
  }
  return points;
}

template <typename T>
rust::Slice<const T> lend(const std::vector<T> &values) {
  return {values.data(), values.size()};
}

}  // namespace walpha
