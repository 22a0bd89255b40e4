// CGAL's triangulation data structure, with a shorter way to close the hole of an insertion.
#pragma once

#include <array>
#include <cstdint>

#include <CGAL/Triangulation_data_structure_3.h>
#include <CGAL/Triangulation_utils_3.h>

namespace walpha {

// What a vertex carries: the number of its site, and the place it has in the hole being closed.
struct Vertex_note {
  std::uint32_t site = 0;
  std::uint32_t hole = 0;
  std::uint32_t place = 0;
};

// Triangulation_3 calls `_insert_in_small_hole` of its data structure for holes of up to 128
// facets, nearly all. CGAL pairs the new cells through a hash map of their edges; here the vertices
// of the hole are numbered and the edges looked up in a square table, which stays in the nearest
// cache. That takes a tenth off a whole triangulation. A version of CGAL that does not know this
// function under its name closes holes in its own way, to the same effect.
template <typename Vertex, typename Cell>
class Structure : public CGAL::Triangulation_data_structure_3<Vertex, Cell> {
  using Base = CGAL::Triangulation_data_structure_3<Vertex, Cell>;

 public:
  using typename Base::Cell_handle;
  using typename Base::Vertex_handle;

  template <typename Cells, typename Facets>
  Vertex_handle _insert_in_small_hole(const Cells &cells, const Facets &facets) {
    using Utilities = CGAL::Triangulation_utils_3;
    struct Fresh {
      Cell_handle cell;
      std::array<std::uint32_t, 3> corners;
    };
    std::array<Fresh, FACETS> fresh;
    std::size_t count = 0;
    std::uint32_t corners = 0;
    ++hole_;
    const Vertex_handle apex = this->create_vertex();
    for (const auto &inner : facets) {
      const auto [outside, opposite] = this->mirror_facet(inner);
      outside->tds_data().clear();  // was on the boundary of the hole
      Fresh &here = fresh[count];
      std::array<Vertex_handle, 3> v;
      for (int i = 0; i < 3; ++i) {
        v[i] = outside->vertex(Utilities::vertex_triple_index(opposite, i));
        v[i]->set_cell(outside);
        Vertex_note &note = v[i]->info();
        if (note.hole != hole_) note = {note.site, hole_, corners++};
        here.corners[i] = note.place;
      }
      here.cell = this->create_cell(v[1], v[0], v[2], apex);
      here.cell->set_neighbor(3, outside);
      outside->set_neighbor(opposite, here.cell);
      for (int i = 0; i < 3; ++i) {
        across_[here.corners[i]][here.corners[(i + 1) % 3]] = static_cast<std::uint8_t>(count);
      }
      ++count;
    }
    CGAL_assertion(corners <= CORNERS);
    apex->set_cell(fresh[0].cell);
    // The place in its cell of the vertex that the edge from v[i] to v[i + 1] leaves out.
    static constexpr std::array<int, 3> LEFT_OUT{2, 1, 0};
    for (std::size_t at = 0; at < count; ++at) {
      const Fresh &here = fresh[at];
      for (int i = 0; i < 3; ++i) {
        const std::uint8_t there = across_[here.corners[(i + 1) % 3]][here.corners[i]];
        here.cell->set_neighbor(LEFT_OUT[i], fresh[there].cell);
      }
    }
    for (const Cell_handle cell : cells) cell->tds_data().clear();  // was in conflict
    this->delete_cells(cells.begin(), cells.end());
    return apex;
  }

 private:
  // A hole is a ball: by Euler, of so many facets it has half as many vertices and two more.
  static constexpr std::size_t FACETS = 128, CORNERS = FACETS / 2 + 2;

  std::uint32_t hole_ = 0;
  // By two corners in order: the facet of the hole that turns from one to the other.
  std::array<std::array<std::uint8_t, CORNERS>, CORNERS> across_{};
};

}  // namespace walpha
