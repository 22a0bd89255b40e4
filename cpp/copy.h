// From a triangulation and a rule that classifies its simplices to the flat arrays of `Complex`.
#pragma once

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include <CGAL/Triangulation_utils_3.h>

#include "walpha/cpp/classes.h"
#include "walpha/cpp/shape.h"

namespace walpha {

// The number of a class of CGAL's alpha shapes.
template <typename Alpha_shape>
Class number(typename Alpha_shape::Classification_type type) {
  if (type == Alpha_shape::INTERIOR) return INTERIOR;
  if (type == Alpha_shape::REGULAR) return REGULAR;
  if (type == Alpha_shape::SINGULAR) return SINGULAR;
  return EXTERIOR;
}

template <typename Triangulation, typename Classify>
std::unique_ptr<Complex> copy(const Triangulation &triangulation, const Classify &classify) {
  using Utilities = CGAL::Triangulation_utils_3;
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

}  // namespace walpha
