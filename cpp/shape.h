// The engine cgal: Regular_triangulation_3 and Fixed_alpha_shape_3, as the paper used CGAL.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "rust/cxx.h"
#include "walpha/cpp/points.h"

namespace walpha {

// A classified complex as flat arrays. Vertices are input indices; a class is the number of
// `Class` on the Rust side. Cells are positively oriented, regular facets turn counter-clockwise
// seen from outside, rows come in no particular order.
class Complex {
 public:
  template <std::size_t N>
  struct Simplices {
    std::vector<std::uint32_t> vertices;  // N per simplex
    std::vector<std::uint8_t> classes;

    void push(const std::array<std::uint32_t, N> &row, std::uint8_t row_class) {
      vertices.insert(vertices.end(), row.begin(), row.end());
      classes.push_back(row_class);
    }
  };

  // Dimension of the affine hull; below 3 nothing is classified and the arrays are empty.
  int dimension() const { return dimension_; }
  rust::Slice<const std::uint32_t> cells() const { return lend(cells_.vertices); }
  rust::Slice<const std::uint32_t> facets() const { return lend(facets_.vertices); }
  rust::Slice<const std::uint32_t> edges() const { return lend(edges_.vertices); }
  rust::Slice<const std::uint32_t> vertices() const { return lend(vertices_.vertices); }
  rust::Slice<const std::uint8_t> cell_classes() const { return lend(cells_.classes); }
  rust::Slice<const std::uint8_t> facet_classes() const { return lend(facets_.classes); }
  rust::Slice<const std::uint8_t> edge_classes() const { return lend(edges_.classes); }
  rust::Slice<const std::uint8_t> vertex_classes() const { return lend(vertices_.classes); }

  int dimension_ = 3;
  Simplices<4> cells_;
  Simplices<3> facets_;
  Simplices<2> edges_;
  Simplices<1> vertices_;
};

// `positions` holds x, y, z of each point, `weights` one number per point; all finite, no
// two positions equal. `alpha` is a squared length, or ±infinity. Every simplex of the
// triangulation is classified; exterior ones are returned too.
std::unique_ptr<Complex> shape(rust::Slice<const double> positions,
                               rust::Slice<const double> weights, double alpha);

}  // namespace walpha
