#include "walpha/cpp/mesh.h"

#include <algorithm>
#include <utility>

#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include "walpha/cpp/lattice_kernel.h"

namespace walpha {
namespace {

using Vertex =
    CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Lattice_kernel,
                                                CGAL::Regular_triangulation_vertex_base_3<Lattice_kernel>>;
// The info is the cell's number in the flat arrays.
using Numbered_cell = CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Lattice_kernel>;
using Cell = CGAL::Regular_triangulation_cell_base_3<Lattice_kernel, Numbered_cell,
                                                     CGAL::Discard_hidden_points>;
using Triangulation =
    CGAL::Regular_triangulation_3<Lattice_kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;

}  // namespace

Mesh::Mesh(const std::vector<Site> &sites, const std::uint8_t *owned, const Lattice &lattice)
    : infinite_(static_cast<std::uint32_t>(sites.size())) {
  std::vector<std::pair<Kernel::Weighted_point_3, std::uint32_t>> points;
  points.reserve(sites.size());
  for (const Site &site : sites) {
    points.emplace_back(site.point(), static_cast<std::uint32_t>(points.size()));
  }
  Triangulation triangulation(points.begin(), points.end(), Lattice_kernel(lattice));
  dimension_ = triangulation.dimension();
  if (dimension_ != 3) return;
  std::vector<std::pair<Kernel::Weighted_point_3, std::uint32_t>>().swap(points);

  triangulation.infinite_vertex()->info() = infinite_;
  const auto touches = [&](const auto &cell) {
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t v = cell->vertex(i)->info();
      if (v != infinite_ && owned[v]) return true;
    }
    return false;
  };
  std::uint32_t count = 0;
  for (auto cell : triangulation.all_cell_handles()) cell->info() = touches(cell) ? count++ : NONE;
  vertices_.reserve(4 * std::size_t{count});
  neighbours_.reserve(4 * std::size_t{count});
  for (auto cell : triangulation.all_cell_handles()) {
    if (cell->info() == NONE) continue;
    for (int i = 0; i < 4; ++i) {
      vertices_.push_back(cell->vertex(i)->info());
      neighbours_.push_back(cell->neighbor(i)->info());
    }
  }
  make_stars(sites.size(), owned);
}

void Mesh::make_stars(std::size_t sites, const std::uint8_t *owned) {
  const auto counted = [&](std::uint32_t v) { return v != infinite_ && owned[v]; };
  star_start_.assign(sites + 1, 0);
  for (const std::uint32_t v : vertices_) {
    if (counted(v)) ++star_start_[v + 1];
  }
  for (std::size_t v = 0; v < sites; ++v) star_start_[v + 1] += star_start_[v];
  star_.resize(star_start_[sites]);
  std::vector<std::uint32_t> at(star_start_.begin(), star_start_.end() - 1);
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const std::uint32_t v = vertices_[i];
    if (counted(v)) star_[at[v]++] = static_cast<std::uint32_t>(i);
  }
}

}  // namespace walpha
