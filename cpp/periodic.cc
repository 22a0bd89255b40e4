#include "walpha/cpp/periodic.h"

#include <array>
#include <map>

#include "walpha/cpp/kernel.h"

#include <CGAL/Periodic_3_regular_triangulation_3.h>
#include <CGAL/Periodic_3_regular_triangulation_traits_3.h>

#include "walpha/cpp/bridge.h"

namespace walpha {
namespace {

using Traits = CGAL::Periodic_3_regular_triangulation_traits_3<Kernel>;
using Triangulation = CGAL::Periodic_3_regular_triangulation_3<Traits>;

}  // namespace

std::unique_ptr<PeriodicTriangulation> periodic(rust::Slice<const double> positions,
                                                rust::Slice<const double> weights, double side) {
  throw_quietly();
  std::vector<Triangulation::Weighted_point> points;
  // CGAL inserts points without numbers of their own, and leaves their coordinates as they are.
  std::map<std::array<double, 3>, std::uint32_t> index;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double *p = positions.data() + 3 * i;
    index[{p[0], p[1], p[2]}] = static_cast<std::uint32_t>(i);
    points.emplace_back(Triangulation::Bare_point(p[0], p[1], p[2]), weights[i]);
  }
  Triangulation triangulation(points.begin(), points.end(),
                              Triangulation::Iso_cuboid(0, 0, 0, side, side, side));
  auto result = std::make_unique<PeriodicTriangulation>();
  result->is_single_ = triangulation.is_triangulation_in_1_sheet();
  if (!result->is_single_) return result;
  triangulation.convert_to_1_sheeted_covering();
  for (auto cell = triangulation.cells_begin(); cell != triangulation.cells_end(); ++cell) {
    for (int i = 0; i < 4; ++i) {
      const auto &p = cell->vertex(i)->point().point();
      result->cells_.push_back(index.at({p.x(), p.y(), p.z()}));
    }
  }
  return result;
}

}  // namespace walpha
