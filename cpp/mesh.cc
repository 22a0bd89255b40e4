#include "walpha/cpp/mesh.h"

#include <algorithm>
#include <utility>

#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include "walpha/cpp/bridge.h"
#include "walpha/cpp/lattice_kernel.h"
#include "walpha/cpp/structure.h"

namespace walpha {
namespace {

// Hidden points are found by their absence, so cells need not remember them: a quarter of a cell's
// size, and an initialised list in each of the many that come and go.
struct No_points {
  using iterator = const Kernel::Weighted_point_3 *;
  using const_iterator = iterator;
  iterator begin() const { return nullptr; }
  iterator end() const { return nullptr; }
};

using Regular_vertex = CGAL::Regular_triangulation_vertex_base_3<Lattice_kernel>;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<Vertex_note, Lattice_kernel,
                                                           Regular_vertex>;
// The info is the cell's number in the flat arrays.
using Numbered_cell = CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Lattice_kernel>;
using Cell = CGAL::Regular_triangulation_cell_base_3<Lattice_kernel, Numbered_cell,
                                                     CGAL::Discard_hidden_points, No_points>;
using Triangulation = CGAL::Regular_triangulation_3<Lattice_kernel, Structure<Vertex, Cell>>;

Extent extent(const std::vector<Site> &sites) {
  const auto along = [&](double Site::*axis) {
    const auto before = [&](const Site &a, const Site &b) { return a.*axis < b.*axis; };
    const auto [low, high] = std::minmax_element(sites.begin(), sites.end(), before);
    return (*high).*axis - (*low).*axis;
  };
  return {along(&Site::x), along(&Site::y), along(&Site::z), along(&Site::weight)};
}

}  // namespace

Mesh::Mesh(const std::vector<Site> &sites, const std::uint8_t *owned, const Lattice &lattice,
           bool frugal)
    : infinite_(static_cast<std::uint32_t>(sites.size())) {
  // In a function of its own, so that the triangulation is gone before the next arrays come.
  triangulate(sites, owned, lattice);
  if (frugal) give_back();
  if (dimension_ == 3) make_stars(sites.size(), owned);
}

void Mesh::triangulate(const std::vector<Site> &sites, const std::uint8_t *owned,
                       const Lattice &lattice) {
  std::vector<std::pair<Kernel::Weighted_point_3, Vertex_note>> points;
  points.reserve(sites.size());
  for (const Site &site : sites) {
    points.emplace_back(site.point(), Vertex_note{static_cast<std::uint32_t>(points.size())});
  }
  Triangulation triangulation(points.begin(), points.end(), Lattice_kernel(lattice, extent(sites)));
  std::vector<std::pair<Kernel::Weighted_point_3, Vertex_note>>().swap(points);
  dimension_ = triangulation.dimension();
  if (dimension_ != 3) return;

  triangulation.infinite_vertex()->info().site = infinite_;
  // Count the cells of each smallest vertex, then number them so.
  first_cell_.assign(sites.size() + 2, 0);
  for (auto cell : triangulation.all_cell_handles()) {
    bool touches = false;
    std::uint32_t smallest = infinite_;
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t v = cell->vertex(i)->info().site;
      if (v == infinite_) continue;
      touches |= owned[v] != 0;
      smallest = std::min(smallest, v);
    }
    cell->info() = touches ? smallest : NONE;
    if (touches) ++first_cell_[smallest + 2];
  }
  for (std::size_t v = 2; v < first_cell_.size(); ++v) first_cell_[v] += first_cell_[v - 1];
  // Afterwards first_cell_[v + 1] has moved on to where the cells of v end.
  for (auto cell : triangulation.all_cell_handles()) {
    if (cell->info() != NONE) cell->info() = first_cell_[cell->info() + 1]++;
  }
  const std::size_t count = first_cell_.back();
  vertices_.resize(4 * count);
  neighbours_.resize(4 * count);
  for (auto cell : triangulation.all_cell_handles()) {
    if (cell->info() == NONE) continue;
    const std::size_t at = 4 * std::size_t{cell->info()};
    for (int i = 0; i < 4; ++i) {
      vertices_[at + i] = cell->vertex(i)->info().site;
      neighbours_[at + i] = cell->neighbor(i)->info();
    }
  }
}

int Mesh::mirror(std::uint32_t cell, int opposite) const {
  const std::uint32_t *v = vertices(cell), *next = neighbours(cell);
  const std::uint32_t *w = vertices(next[opposite]), *back = neighbours(next[opposite]);
  // Two cells may share two facets; the right one is opposite a vertex that is not on this one.
  const auto on_facet = [&](std::uint32_t vertex) {
    return vertex == v[(opposite + 1) & 3] || vertex == v[(opposite + 2) & 3] ||
           vertex == v[(opposite + 3) & 3];
  };
  int j = 0;
  while (back[j] != cell || on_facet(w[j])) ++j;
  return j;
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
