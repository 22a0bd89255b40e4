#include "walpha/cpp/shape.h"

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <CGAL/Fixed_alpha_shape_3.h>
#include <CGAL/Fixed_alpha_shape_cell_base_3.h>
#include <CGAL/Fixed_alpha_shape_vertex_base_3.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include "walpha/cpp/bridge.h"
#include "walpha/cpp/classes.h"
#include "walpha/cpp/kernel.h"

namespace walpha {
namespace {

using Regular_vertex = CGAL::Regular_triangulation_vertex_base_3<Kernel>;
using Alpha_vertex = CGAL::Fixed_alpha_shape_vertex_base_3<Kernel, Regular_vertex>;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel, Alpha_vertex>;
using Regular_cell = CGAL::Regular_triangulation_cell_base_3<Kernel>;
using Cell = CGAL::Fixed_alpha_shape_cell_base_3<Kernel, Regular_cell>;
using Structure = CGAL::Triangulation_data_structure_3<Vertex, Cell>;
using Triangulation = CGAL::Regular_triangulation_3<Kernel, Structure>;
using Alpha_shape = CGAL::Fixed_alpha_shape_3<Triangulation>;
using Utilities = CGAL::Triangulation_utils_3;

Class number(Alpha_shape::Classification_type type) {
  if (type == Alpha_shape::INTERIOR) return INTERIOR;
  if (type == Alpha_shape::REGULAR) return REGULAR;
  if (type == Alpha_shape::SINGULAR) return SINGULAR;
  return EXTERIOR;
}

// α = ∞ or −∞: a question CGAL must not be asked, and one whose answer needs no arithmetic.
class Infinite_alpha {
 public:
  Infinite_alpha(const Triangulation &triangulation, bool all) : all_(all) {
    if (!all_) return;
    const auto outside = triangulation.infinite_vertex();
    std::vector<Triangulation::Cell_handle> cells;
    triangulation.incident_cells(outside, std::back_inserter(cells));
    for (const auto &cell : cells) {
      for (int i = 0; i < 3; ++i) {
        const int opposite = cell->index(outside);
        const auto a = cell->vertex((opposite + 1 + i) % 4);
        const auto b = cell->vertex((opposite + 1 + (i + 1) % 3) % 4);
        hull_.insert(std::minmax(a->info(), b->info()));
        hull_.insert({a->info(), a->info()});
      }
    }
  }

  Class cell() const { return all_ ? INTERIOR : EXTERIOR; }
  Class facet(bool on_hull) const { return on_hull && all_ ? REGULAR : cell(); }
  Class edge(std::uint32_t a, std::uint32_t b) const {
    return all_ && hull_.count(std::minmax(a, b)) != 0 ? REGULAR : cell();
  }

 private:
  bool all_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> hull_;
};

struct Infinite_classes {
  const Triangulation &triangulation;
  Infinite_alpha of;

  Class operator()(Triangulation::Cell_handle) const { return of.cell(); }
  Class operator()(const Triangulation::Facet &facet) const {
    return of.facet(triangulation.is_infinite(facet.first) ||
                    triangulation.is_infinite(facet.first->neighbor(facet.second)));
  }
  Class operator()(const Triangulation::Edge &edge) const {
    return of.edge(edge.first->vertex(edge.second)->info(), edge.first->vertex(edge.third)->info());
  }
  Class operator()(Triangulation::Vertex_handle vertex) const {
    return of.edge(vertex->info(), vertex->info());
  }
};

template <typename Classify>
std::unique_ptr<Complex> copy(const Triangulation &triangulation, const Classify &classify) {
  auto complex = std::make_unique<Complex>();
  for (auto cell : triangulation.finite_cell_handles()) {
    complex->cells_.push({cell->vertex(0)->info(), cell->vertex(1)->info(),
                          cell->vertex(2)->info(), cell->vertex(3)->info()},
                         classify(cell));
  }
  for (auto facet : triangulation.finite_facets()) {
    const Class facet_class = classify(facet);
    // vertex_triple_index turns counter-clockwise seen from inside facet.first, so a regular
    // facet is taken from the cell that is not in the shape.
    if (facet_class == REGULAR && !triangulation.is_infinite(facet.first) &&
        classify(facet.first) == INTERIOR) {
      facet = triangulation.mirror_facet(facet);
    }
    const auto vertex = [&](int i) {
      return facet.first->vertex(Utilities::vertex_triple_index(facet.second, i))->info();
    };
    complex->facets_.push({vertex(0), vertex(1), vertex(2)}, facet_class);
  }
  for (const auto &edge : triangulation.finite_edges()) {
    complex->edges_.push(
        {edge.first->vertex(edge.second)->info(), edge.first->vertex(edge.third)->info()},
        classify(edge));
  }
  for (auto vertex : triangulation.finite_vertex_handles()) {
    complex->vertices_.push({vertex->info()}, classify(vertex));
  }
  return complex;
}

}  // namespace

std::unique_ptr<Complex> shape(rust::Slice<const double> positions,
                               rust::Slice<const double> weights, double alpha) {
  throw_quietly();
  std::vector<std::pair<Triangulation::Weighted_point, std::uint32_t>> points;
  points.reserve(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double *p = positions.data() + 3 * i;
    points.emplace_back(Triangulation::Weighted_point({p[0], p[1], p[2]}, weights[i]),
                        static_cast<std::uint32_t>(i));
  }
  Triangulation triangulation(points.begin(), points.end());
  decltype(points)().swap(points);
  // Fixed_alpha_shape_3 leaves its classes uninitialised in lower dimensions.
  if (triangulation.dimension() != 3) {
    auto nothing = std::make_unique<Complex>();
    nothing->dimension_ = triangulation.dimension();
    return nothing;
  }
  if (std::isinf(alpha)) {
    return copy(triangulation, Infinite_classes{triangulation, {triangulation, alpha > 0}});
  }
  const Alpha_shape shape(triangulation, alpha);  // takes the triangulation over
  return copy(shape, [&](const auto &simplex) { return number(shape.classify(simplex)); });
}

}  // namespace walpha
