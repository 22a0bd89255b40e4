// CGAL's Epic_converter copies a default Weighted_point_2 it never reads; GCC warns of it here,
// because that is where the template is instantiated.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "walpha/cpp/plane.h"

#include <algorithm>
#include <utility>

#include "walpha/cpp/kernel.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Regular_triangulation_face_base_2.h>
#include <CGAL/Regular_triangulation_vertex_base_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "walpha/cpp/bridge.h"

namespace walpha {
namespace {

using Exact_kernel = CGAL::Exact_predicates_exact_constructions_kernel;

template <typename K>
using Site = std::pair<typename K::Weighted_point_2, std::uint32_t>;

template <typename K>
std::unique_ptr<PlaneTriangulation> triangulate(std::vector<Site<K>> sites) {
  using Vertex = CGAL::Triangulation_vertex_base_with_info_2<
      std::uint32_t, K, CGAL::Regular_triangulation_vertex_base_2<K>>;
  using Face = CGAL::Regular_triangulation_face_base_2<K>;
  using Triangulation =
      CGAL::Regular_triangulation_2<K, CGAL::Triangulation_data_structure_2<Vertex, Face>>;

  // Without this, which of several cocircular triangulations comes out depends on input order.
  std::sort(sites.begin(), sites.end(), [](const Site<K> &a, const Site<K> &b) {
    return a.first.point() < b.first.point();
  });
  Triangulation triangulation;
  triangulation.insert(sites.begin(), sites.end());

  auto result = std::make_unique<PlaneTriangulation>();
  for (auto face : triangulation.finite_face_handles()) {
    for (int i = 0; i < 3; ++i) result->triangles_.push_back(face->vertex(i)->info());
  }
  for (const auto &edge : triangulation.finite_edges()) {
    for (int i : {Triangulation::cw(edge.second), Triangulation::ccw(edge.second)}) {
      result->edges_.push_back(edge.first->vertex(i)->info());
    }
  }
  for (auto vertex : triangulation.finite_vertex_handles()) {
    result->vertices_.push_back(vertex->info());
  }
  return result;
}

}  // namespace

std::unique_ptr<PlaneTriangulation> regular_plane(rust::Slice<const double> positions,
                                                  rust::Slice<const double> weights) {
  throw_quietly();
  std::vector<Site<Kernel>> sites;
  sites.reserve(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sites.emplace_back(
        Kernel::Weighted_point_2({positions[2 * i], positions[2 * i + 1]}, weights[i]),
        static_cast<std::uint32_t>(i));
  }
  return triangulate<Kernel>(std::move(sites));
}

std::unique_ptr<PlaneTriangulation> farthest_plane(rust::Slice<const double> positions) {
  throw_quietly();
  std::vector<Site<Exact_kernel>> sites;
  sites.reserve(positions.size() / 2);
  for (std::size_t i = 0; 2 * i < positions.size(); ++i) {
    const Exact_kernel::FT x = positions[2 * i], y = positions[2 * i + 1];
    sites.emplace_back(Exact_kernel::Weighted_point_2({x, y}, 2 * (x * x + y * y)),
                       static_cast<std::uint32_t>(i));
  }
  return triangulate<Exact_kernel>(std::move(sites));
}

}  // namespace walpha
