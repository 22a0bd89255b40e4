// The part of a regular triangulation around the points of a slab, as flat arrays.
#pragma once

#include <cstdint>
#include <vector>

#include "walpha/cpp/lattice.h"
#include "walpha/cpp/predicates.h"

namespace walpha {

// Cells that touch an owned point, infinite ones included, in CGAL's vertex order: positively
// oriented, where the infinite vertex counts as a point far outside. They are numbered by their
// smallest vertices, so that cells near each other in space are near each other in memory.
class Mesh {
 public:
  static constexpr std::uint32_t NONE = UINT32_MAX;

  // Triangulates `sites`; `owned` has a flag for each. Only the arrays outlive the call. A frugal
  // mesh gives the memory of the triangulation back at once: a fourth off the peak, but slower.
  Mesh(const std::vector<Site> &sites, const std::uint8_t *owned, const Lattice &lattice,
       bool frugal);

  int dimension() const { return dimension_; }
  std::uint32_t cells() const { return static_cast<std::uint32_t>(vertices_.size() / 4); }
  // The number of the infinite vertex: one past the last site.
  std::uint32_t infinite() const { return infinite_; }
  const std::uint32_t *vertices(std::uint32_t cell) const {
    return &vertices_[4 * std::size_t{cell}];
  }
  // The cells opposite the vertices; NONE for one that touches no owned point.
  const std::uint32_t *neighbours(std::uint32_t cell) const {
    return &neighbours_[4 * std::size_t{cell}];
  }
  // The place in its neighbour of the facet opposite a vertex of a cell.
  int mirror(std::uint32_t cell, int opposite) const;
  // The first cell whose smallest vertex is this site or a later one.
  std::uint32_t first_cell(std::uint32_t site) const { return first_cell_[site]; }

  // The cells around an owned site, as 4·cell + place of the site in it, ascending.
  struct Star {
    const std::uint32_t *first, *last;
    const std::uint32_t *begin() const { return first; }
    const std::uint32_t *end() const { return last; }
  };
  Star star(std::uint32_t site) const {
    return {star_.data() + star_start_[site], star_.data() + star_start_[site + 1]};
  }

 private:
  void triangulate(const std::vector<Site> &sites, const std::uint8_t *owned,
                   const Lattice &lattice);
  void make_stars(std::size_t sites, const std::uint8_t *owned);

  int dimension_ = 3;
  std::uint32_t infinite_;
  std::vector<std::uint32_t> vertices_, neighbours_, first_cell_, star_, star_start_;
};

}  // namespace walpha
