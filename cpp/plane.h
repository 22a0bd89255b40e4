// Triangulations in the plane: Regular_triangulation_2, closest-point and farthest-point.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rust/cxx.h"
#include "walpha/cpp/points.h"

namespace walpha {

// A triangulation of the plane as flat arrays of input indices, in no particular order. Triangles
// turn counter-clockwise. Points that are vertices of no simplex are hidden.
class PlaneTriangulation {
 public:
  rust::Slice<const std::uint32_t> triangles() const { return lend(triangles_); }
  rust::Slice<const std::uint32_t> edges() const { return lend(edges_); }
  rust::Slice<const std::uint32_t> vertices() const { return lend(vertices_); }

  std::vector<std::uint32_t> triangles_;  // 3 per triangle; empty for points on one line
  std::vector<std::uint32_t> edges_;      // 2 per edge
  std::vector<std::uint32_t> vertices_;
};

// `positions` holds x, y of each point, `weights` one number per point; all finite, no two
// positions equal. Any number of points will do, and they may lie on one line: then there are no
// triangles. The answer is a function of the set of points, ties included: they are inserted in
// (x, y) order.
std::unique_ptr<PlaneTriangulation> regular_plane(rust::Slice<const double> positions,
                                                  rust::Slice<const double> weights);

// The farthest-point Delaunay triangulation of the positions: the regular triangulation for the
// weights 2|p|², which no double need hold, so they are computed and compared exactly.
std::unique_ptr<PlaneTriangulation> farthest_plane(rust::Slice<const double> positions);

}  // namespace walpha
