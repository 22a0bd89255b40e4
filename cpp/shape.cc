#include "walpha/cpp/shape.h"

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "walpha/cpp/kernel.h"

#include <CGAL/Fixed_alpha_shape_3.h>
#include <CGAL/Fixed_alpha_shape_cell_base_3.h>
#include <CGAL/Fixed_alpha_shape_vertex_base_3.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include "walpha/cpp/bridge.h"
#include "walpha/cpp/classes.h"
#include "walpha/cpp/copy.h"
#include "walpha/cpp/points.h"

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

}  // namespace

std::unique_ptr<Complex> shape(rust::Slice<const double> positions,
                               rust::Slice<const double> weights, double alpha) {
  throw_quietly();
  auto points = numbered<Triangulation>(positions, weights);
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
  return copy(shape, [&](const auto &simplex) { return number<Alpha_shape>(shape.classify(simplex)); });
}

}  // namespace walpha
