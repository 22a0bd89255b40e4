// Periodic_3_regular_triangulation_3 as arrays.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rust/cxx.h"
#include "walpha/cpp/points.h"

namespace walpha {

// A regular triangulation of a cube whose opposite faces are identified.
class PeriodicTriangulation {
 public:
  // Whether one copy of the cube is enough; else the arrays are empty.
  bool is_single() const { return is_single_; }
  // Input indices, 4 per cell, in no particular order.
  rust::Slice<const std::uint32_t> cells() const { return lend(cells_); }

  bool is_single_ = true;
  std::vector<std::uint32_t> cells_;
};

// Positions are distinct, from 0 to less than the side along each axis, and weights from 0 to less
// than 1/64 of the squared side.
std::unique_ptr<PeriodicTriangulation> periodic(rust::Slice<const double> positions,
                                                rust::Slice<const double> weights, double side);

}  // namespace walpha
