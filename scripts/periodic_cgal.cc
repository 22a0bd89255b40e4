// CGAL's periodic regular triangulation of weighted points in a cube, for scripts/check_periodic.py.
//
// Reads the side of the cube, then x y z weight of each point, the weights from 0 to less than 1/64 of the squared
// side. Writes the cells by the numbers of the points, each ascending; nothing if they need more than one copy of
// the cube.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Periodic_3_regular_triangulation_3.h>
#include <CGAL/Periodic_3_regular_triangulation_traits_3.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Traits = CGAL::Periodic_3_regular_triangulation_traits_3<Kernel>;
using Triangulation = CGAL::Periodic_3_regular_triangulation_3<Traits>;
using Point = Triangulation::Weighted_point;

int main() {
  double side, x, y, z, weight;
  std::cin >> side;
  std::vector<Point> points;
  std::map<std::array<double, 3>, int> number;
  while (std::cin >> x >> y >> z >> weight) {
    number[{x, y, z}] = static_cast<int>(points.size());
    points.emplace_back(Triangulation::Bare_point(x, y, z), weight);
  }
  Triangulation triangulation(points.begin(), points.end(),
                              Triangulation::Iso_cuboid(0, 0, 0, side, side, side));
  if (!triangulation.is_triangulation_in_1_sheet()) return 0;
  triangulation.convert_to_1_sheeted_covering();
  for (auto cell = triangulation.cells_begin(); cell != triangulation.cells_end(); ++cell) {
    std::array<int, 4> row;
    for (int k = 0; k < 4; ++k) {
      const auto& p = cell->vertex(k)->point().point();
      row[k] = number.at({p.x(), p.y(), p.z()});
    }
    std::sort(row.begin(), row.end());
    std::cout << row[0] << ' ' << row[1] << ' ' << row[2] << ' ' << row[3] << '\n';
  }
}
