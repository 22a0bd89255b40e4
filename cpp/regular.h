// CGAL's Regular_triangulation_3 as it comes, copied out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "rust/cxx.h"

namespace walpha {

// A regular triangulation. Its cells are numbered from 0, infinite ones included; the infinite vertex
// has the number one past the last point.
class Regular {
 public:
  struct Data;
  explicit Regular(std::unique_ptr<Data> data);
  ~Regular();

  // Of the affine hull; below 3 there are no cells.
  int dimension() const;
  std::size_t cells() const;
  // Writes the four vertices of each cell, positively oriented, and for each of these what lies across
  // the facet opposite: 4·cell + the place of the vertex beyond. Four numbers for each cell.
  void copy(rust::Slice<std::uint32_t> vertices, rust::Slice<std::uint32_t> beside) const;

 private:
  std::unique_ptr<Data> data_;
};

// `positions` holds x, y, z of each point, `weights` one number per point; all finite, no two
// positions equal. `order` holds each point once, as they are inserted.
std::unique_ptr<Regular> regular(rust::Slice<const double> positions,
                                 rust::Slice<const double> weights,
                                 rust::Slice<const std::uint32_t> order);

}  // namespace walpha
