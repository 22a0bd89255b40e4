#include "walpha/cpp/regular.h"

#include <limits>

#include "walpha/cpp/kernel.h"

#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include "walpha/cpp/bridge.h"

namespace walpha {
namespace {

using Vertex = CGAL::Triangulation_vertex_base_with_info_3<
    std::uint32_t, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using Cell = CGAL::Triangulation_cell_base_with_info_3<
    std::uint32_t, Kernel, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Triangulation =
    CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;

}  // namespace

std::unique_ptr<RegularTriangulation> regular_space(rust::Slice<const double> positions,
                                                    rust::Slice<const double> weights) {
  throw_quietly();
  const auto points = numbered<Triangulation>(positions, weights);
  const Triangulation triangulation(points.begin(), points.end());
  auto result = std::make_unique<RegularTriangulation>();
  result->dimension_ = triangulation.dimension();
  if (result->dimension_ != 3) return result;
  std::uint32_t count = 0;
  for (auto cell : triangulation.all_cell_handles()) {
    cell->info() = triangulation.is_infinite(cell) ? std::numeric_limits<std::uint32_t>::max() : count++;
  }
  for (auto cell : triangulation.finite_cell_handles()) {
    for (int i = 0; i < 4; ++i) {
      result->cells_.push_back(cell->vertex(i)->info());
      result->neighbours_.push_back(cell->neighbor(i)->info());
    }
  }
  for (auto vertex : triangulation.finite_vertex_handles()) {
    result->vertices_.push_back(vertex->info());
  }
  return result;
}

}  // namespace walpha
