#include "walpha/cpp/regular.h"

#include <utility>

#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include "walpha/cpp/bridge.h"
#include "walpha/cpp/kernel.h"

namespace walpha {
namespace {

using Regular_vertex = CGAL::Regular_triangulation_vertex_base_3<Kernel>;
// The info of a vertex is its point's number, that of a cell its own.
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel, Regular_vertex>;
using Numbered_cell = CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel>;
using Cell = CGAL::Regular_triangulation_cell_base_3<Kernel, Numbered_cell>;
using Structure = CGAL::Triangulation_data_structure_3<Vertex, Cell>;
using Triangulation = CGAL::Regular_triangulation_3<Kernel, Structure>;

}  // namespace

struct Regular::Data {
  Triangulation triangulation;
};

Regular::Regular(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Regular::~Regular() = default;

int Regular::dimension() const { return data_->triangulation.dimension(); }

std::size_t Regular::cells() const { return data_->triangulation.number_of_cells(); }

void Regular::copy(rust::Slice<std::uint32_t> vertices, rust::Slice<std::uint32_t> beside) const {
  if (vertices.size() != 4 * cells() || beside.size() != 4 * cells()) {
    throw std::logic_error("four vertices and four neighbours are copied for each cell");
  }
  std::uint32_t count = 0;
  for (auto cell : data_->triangulation.all_cell_handles()) cell->info() = count++;
  std::size_t at = 0;
  for (auto cell : data_->triangulation.all_cell_handles()) {
    for (int i = 0; i < 4; ++i, ++at) {
      const auto next = cell->neighbor(i);
      vertices[at] = cell->vertex(i)->info();
      beside[at] = 4 * next->info() + static_cast<std::uint32_t>(next->index(cell));
    }
  }
}

std::unique_ptr<Regular> regular(rust::Slice<const double> positions,
                                 rust::Slice<const double> weights,
                                 rust::Slice<const std::uint32_t> order) {
  throw_quietly();
  auto data = std::make_unique<Regular::Data>();
  auto &triangulation = data->triangulation;
  Triangulation::Cell_handle near;
  for (const auto i : order) {
    const double *p = positions.data() + 3 * std::size_t{i};
    const Triangulation::Weighted_point point({p[0], p[1], p[2]}, weights[i]);
    Triangulation::Locate_type place;
    int j, k;
    near = triangulation.locate(point, place, j, k, near);
    const auto vertex = triangulation.insert(point, place, near, j, k);
    if (vertex == Triangulation::Vertex_handle()) continue;
    vertex->info() = i;
    near = vertex->cell();
  }
  triangulation.infinite_vertex()->info() = static_cast<std::uint32_t>(weights.size());
  return std::make_unique<Regular>(std::move(data));
}

}  // namespace walpha
