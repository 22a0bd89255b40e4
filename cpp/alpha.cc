#include "walpha/cpp/alpha.h"

#include <cmath>
#include <limits>

#include "walpha/cpp/kernel.h"

#include <CGAL/Alpha_shape_3.h>
#include <CGAL/Alpha_shape_cell_base_3.h>
#include <CGAL/Alpha_shape_vertex_base_3.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include "walpha/cpp/bridge.h"
#include "walpha/cpp/copy.h"
#include "walpha/cpp/nearest.h"

namespace walpha {
namespace {

// Values of α are compared exactly, and points are weighted.
using Exact = CGAL::Tag_true;
using Weighted = CGAL::Tag_true;
using Alpha_vertex =
    CGAL::Alpha_shape_vertex_base_3<Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>,
                                    Exact, Weighted>;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel, Alpha_vertex>;
using Cell = CGAL::Alpha_shape_cell_base_3<
    Kernel, CGAL::Regular_triangulation_cell_base_3<Kernel>, Exact, Weighted>;
using Triangulation =
    CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
using Alpha_shape = CGAL::Alpha_shape_3<Triangulation, Exact>;
using Value = Alpha_shape::FT;

constexpr std::uint32_t NONE = std::numeric_limits<std::uint32_t>::max();

}  // namespace

struct AlphaShape::Made {
  Alpha_shape shape;

  Made(Triangulation &triangulation, Alpha_shape::Mode mode) : shape(triangulation, 0, mode) {}

  // α as CGAL takes it: no infinity. The largest value stands for ∞, and no value is below −max.
  Value value(double alpha) const {
    if (!std::isinf(alpha)) return alpha;
    return alpha > 0 ? *(shape.alpha_end() - 1) : Value(std::numeric_limits<double>::lowest());
  }

  std::uint32_t rank(const Value &value) const {
    const auto at = shape.alpha_lower_bound(value);
    CGAL_assertion(at != shape.alpha_end() && *at == value);
    return static_cast<std::uint32_t>(at - shape.alpha_begin());
  }

  void push(Simplices &to, std::initializer_list<Alpha_shape::Vertex_handle> row,
            const Alpha_shape::Alpha_status &status) const {
    for (const auto vertex : row) to.vertices.push_back(vertex->info());
    const bool has_min = shape.get_mode() == Alpha_shape::GENERAL && status.is_Gabriel();
    to.ranks.push_back(has_min ? rank(status.alpha_min()) : NONE);
    to.ranks.push_back(rank(status.alpha_mid()));
    to.ranks.push_back(status.is_on_chull() ? NONE : rank(status.alpha_max()));
  }

  Alpha_shape::Alpha_status status(const Alpha_shape::Edge &edge) const {
    if (shape.get_mode() == Alpha_shape::GENERAL) return shape.get_alpha_status(edge);
    // CGAL keeps none in this mode.
    Alpha_shape::Alpha_status status;
    shape.compute_edge_status(edge.first, edge.second, edge.third, status);
    return status;
  }
};

AlphaShape::AlphaShape() = default;
AlphaShape::~AlphaShape() = default;

std::uint32_t AlphaShape::find_optimal_alpha(std::size_t components) const {
  const auto &shape = made_->shape;
  return static_cast<std::uint32_t>(shape.find_optimal_alpha(components) - shape.alpha_begin());
}

std::size_t AlphaShape::solid_components(double alpha) const {
  return made_->shape.number_of_solid_components(made_->value(alpha));
}

std::size_t AlphaShape::solid_components_of(std::uint32_t rank) const {
  return made_->shape.number_of_solid_components(*(made_->shape.alpha_begin() + rank));
}

std::unique_ptr<Complex> AlphaShape::classify(double alpha) const {
  const auto &shape = made_->shape;
  const Value value = made_->value(alpha);
  return copy(shape, [&](const auto &simplex) {
    return number<Alpha_shape>(shape.classify(simplex, value));
  });
}

std::unique_ptr<AlphaShape> alpha_shape(rust::Slice<const double> positions,
                                        rust::Slice<const double> weights, bool regularized) {
  throw_quietly();
  const auto points = numbered<Triangulation>(positions, weights);
  Triangulation triangulation(points.begin(), points.end());
  auto result = std::make_unique<AlphaShape>();
  result->dimension_ = triangulation.dimension();
  if (result->dimension_ != 3) return result;
  result->made_ = std::make_unique<AlphaShape::Made>(
      triangulation, regularized ? Alpha_shape::REGULARIZED : Alpha_shape::GENERAL);
  const auto &made = *result->made_;
  const auto &shape = made.shape;

  for (auto value = shape.alpha_begin(); value != shape.alpha_end(); ++value) {
    result->values_.push_back(nearest(value->exact()));
  }
  for (auto cell : shape.finite_cell_handles()) {
    for (int i = 0; i < 4; ++i) result->cells_.push_back(cell->vertex(i)->info());
    result->cell_ranks_.push_back(made.rank(cell->get_alpha()));
  }
  for (const auto &facet : shape.finite_facets()) {
    const auto vertex = [&](int i) { return facet.first->vertex((facet.second + i) % 4); };
    made.push(result->facets_, {vertex(1), vertex(2), vertex(3)}, shape.get_alpha_status(facet));
  }
  for (const auto &edge : shape.finite_edges()) {
    made.push(result->edges_, {edge.first->vertex(edge.second), edge.first->vertex(edge.third)},
              made.status(edge));
  }
  for (auto vertex : shape.finite_vertex_handles()) {
    made.push(result->vertices_, {vertex}, *vertex->get_alpha_status());
  }
  return result;
}

}  // namespace walpha
