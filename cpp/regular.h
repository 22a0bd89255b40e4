// Regular_triangulation_3 as arrays.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rust/cxx.h"
#include "walpha/cpp/points.h"

namespace walpha {

// A regular triangulation as flat arrays of input indices. Cells are positively oriented and in no
// particular order; points that are vertices of none are hidden.
class RegularTriangulation {
 public:
  // Of the affine hull; below 3 the arrays are empty.
  int dimension() const { return dimension_; }
  rust::Slice<const std::uint32_t> cells() const { return lend(cells_); }
  rust::Slice<const std::uint32_t> neighbours() const { return lend(neighbours_); }
  rust::Slice<const std::uint32_t> vertices() const { return lend(vertices_); }

  int dimension_ = 3;
  std::vector<std::uint32_t> cells_;       // 4 per cell
  std::vector<std::uint32_t> neighbours_;  // 4 per cell; the largest number where it is infinite
  std::vector<std::uint32_t> vertices_;
};

// As for `shape` in shape.h.
std::unique_ptr<RegularTriangulation> regular_space(rust::Slice<const double> positions,
                                                    rust::Slice<const double> weights);

}  // namespace walpha
