// The slabs engine: one slab and its halo, triangulated and classified over flat arrays.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "rust/cxx.h"

namespace walpha {

struct Question;  // src/cgal/ffi.rs

// What a slab knows of the shape: the simplices whose smallest vertex it owns, around one owned
// point after the other, so that rows come in canonical order. That vertex is left out of them: a
// quarter to a half of the memory that the answer takes while slabs wait for each other.
class Slab {
 public:
  int dimension() const { return dimension_; }
  rust::Slice<const std::uint32_t> cells() const { return lend(cells_); }
  rust::Slice<const std::uint32_t> facets() const { return lend(facets_); }
  rust::Slice<const std::uint32_t> edges() const { return lend(edges_); }
  rust::Slice<const std::uint8_t> cell_classes() const { return lend(cell_classes_); }
  rust::Slice<const std::uint8_t> facet_classes() const { return lend(facet_classes_); }
  rust::Slice<const std::uint8_t> edge_classes() const { return lend(edge_classes_); }
  // One class for each owned point, HIDDEN for those that are no vertices of this triangulation.
  rust::Slice<const std::uint8_t> vertex_classes() const { return lend(vertex_classes_); }
  // How many cells, facets and edges each owned point is the smallest vertex of, in turn.
  rust::Slice<const std::uint32_t> counts() const { return lend(counts_); }

  // The sheet of each boundary facet, and the two of each singular facet, in the order of
  // facets(): first that on the side where the facet's sorted row turns clockwise. Sheets are
  // numbered from 0 within the slab.
  rust::Slice<const std::uint32_t> facet_sheets() const { return lend(facet_sheets_); }
  // The sheet of each singular edge, in the order of edges().
  rust::Slice<const std::uint32_t> edge_sheets() const { return lend(edge_sheets_); }
  // Sides of facets, and singular edges, that touch points of this slab and of others: five
  // numbers each, namely three sorted input indices (edges repeat the last), side, sheet.
  rust::Slice<const std::uint32_t> shared() const { return lend(shared_); }
  std::uint32_t sheets() const { return sheets_; }

  // Give memory back.
  void drop_shared() { drop(shared_); }
  void drop_cells() { drop(cells_, cell_classes_); }
  void drop_facets() { drop(facets_, facet_classes_, facet_sheets_); }

  int dimension_ = 3;
  std::uint32_t sheets_ = 0;
  std::vector<std::uint32_t> cells_, facets_, edges_, counts_;
  std::vector<std::uint32_t> facet_sheets_, edge_sheets_, shared_;
  std::vector<std::uint8_t> cell_classes_, facet_classes_, edge_classes_, vertex_classes_;

 private:
  template <typename... Vectors>
  static void drop(Vectors &...vectors) {
    (Vectors().swap(vectors), ...);
  }
  template <typename T>
  static rust::Slice<const T> lend(const std::vector<T> &values) {
    return {values.data(), values.size()};
  }
};

// Points of a slab and its halo, ascending by input index. `input` holds that index, `owned` 1 for
// the slab's own points. Exterior simplices mean something in a triangulation of all points only.
std::unique_ptr<Slab> slab(rust::Slice<const double> positions, rust::Slice<const double> weights,
                           rust::Slice<const std::uint32_t> input,
                           rust::Slice<const std::uint8_t> owned, const Question &question);

}  // namespace walpha
