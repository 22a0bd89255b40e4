// Alpha_shape_3 with exact comparisons, general or regularized.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rust/cxx.h"
#include "walpha/cpp/points.h"
#include "walpha/cpp/shape.h"

namespace walpha {

// The alpha shapes of weighted points for all values of α. A value is named by its rank among all
// values, which CGAL sorts exactly. Simplices are rows of input indices in no particular order;
// beside each row stand the ranks of its alpha_min, alpha_mid and alpha_max, the largest number
// where CGAL has none: no alpha_min if the simplex is not Gabriel or the shape is regularized, no
// alpha_max on the convex hull.
class AlphaShape {
 public:
  AlphaShape();
  ~AlphaShape();

  // Of the affine hull; below 3 the arrays are empty, and nothing else may be called.
  int dimension() const { return dimension_; }
  // The doubles nearest to the values.
  rust::Slice<const double> values() const { return lend(values_); }
  rust::Slice<const std::uint32_t> cells() const { return lend(cells_); }
  rust::Slice<const std::uint32_t> cell_ranks() const { return lend(cell_ranks_); }
  rust::Slice<const std::uint32_t> facets() const { return lend(facets_.vertices); }
  rust::Slice<const std::uint32_t> facet_ranks() const { return lend(facets_.ranks); }
  rust::Slice<const std::uint32_t> edges() const { return lend(edges_.vertices); }
  rust::Slice<const std::uint32_t> edge_ranks() const { return lend(edges_.ranks); }
  rust::Slice<const std::uint32_t> vertices() const { return lend(vertices_.vertices); }
  rust::Slice<const std::uint32_t> vertex_ranks() const { return lend(vertices_.ranks); }

  // A rank. `components` is at least 1.
  std::uint32_t find_optimal_alpha(std::size_t components) const;
  std::size_t solid_components(double alpha) const;
  std::size_t solid_components_of(std::uint32_t rank) const;
  // The classes of all simplices. α may be infinite, as in `solid_components`.
  std::unique_ptr<Complex> classify(double alpha) const;

  struct Simplices {
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t> ranks;
  };
  // What CGAL makes, which is not for this header: whatever includes it would compile CGAL.
  struct Made;

  int dimension_ = 3;
  std::vector<double> values_;
  std::vector<std::uint32_t> cells_, cell_ranks_;
  Simplices facets_, edges_, vertices_;
  std::unique_ptr<Made> made_;
};

// `positions` and `weights` as for `shape` in shape.h.
std::unique_ptr<AlphaShape> alpha_shape(rust::Slice<const double> positions,
                                        rust::Slice<const double> weights, bool regularized);

}  // namespace walpha
