// GUDHI's alpha complex with its simplex tree, compiled for this processor: the quickest of its forms for points in space.
//
//   race_gudhi POINTS N RUNS     POINTS: x, y, z, ω of each point as little-endian doubles; the first N of them
//
// From GUDHI's sources, of which the headers are enough, with those of CGAL 6 before the system's where they are at hand (Debian:
// libeigen3-dev):
//
//   c++ -std=c++17 -O3 -DNDEBUG -march=native -frounding-math $(printf -- '-I%s ' gudhi-devel/src/*/include) -I/usr/include/eigen3 \
//     -o race_gudhi benches/race_gudhi.cc -lmpfr -lgmp
//
// Prints the median of seconds from points in memory to the tree, and its simplices.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <CGAL/Epick_d.h>
#include <gudhi/Alpha_complex.h>
#include <gudhi/Simplex_tree.h>

struct Contiguous : Gudhi::Simplex_tree_options_default {
  static const bool contiguous_vertices = true;
};
using Kernel = CGAL::Epick_d<CGAL::Dimension_tag<3>>;

int main(int given, char **arguments) {
  if (given != 4) return 2;
  const std::size_t count = std::strtoul(arguments[2], nullptr, 10);
  const int runs = std::atoi(arguments[3]);
  std::vector<double> rows(4 * count);
  std::FILE *file = std::fopen(arguments[1], "rb");
  if (!file || std::fread(rows.data(), sizeof(double), rows.size(), file) != rows.size()) return 1;
  std::vector<Kernel::Point_d> points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(rows[4 * i], rows[4 * i + 1], rows[4 * i + 2]);
  std::vector<double> times;
  std::size_t simplices = 0;
  for (int run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    Gudhi::alpha_complex::Alpha_complex<Kernel> alpha(points);
    Gudhi::Simplex_tree<Contiguous> tree;
    alpha.create_complex(tree);
    times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    simplices = tree.num_simplices();
  }
  std::sort(times.begin(), times.end());
  std::printf("%.5f %zu\n", times[times.size() / 2], simplices);
}
