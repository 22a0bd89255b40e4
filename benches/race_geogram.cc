// Geogram's regular triangulation, for benches/race: sequential on one thread, its parallel one on several.
//
//   race_geogram POINTS THREADS [CELLS]     POINTS: x, y, z, ω of each point as little-endian doubles
//
// Weights are handed over as a fourth coordinate, √(max ω − ω), which Geogram squares again: rounded.
// Prints seconds, peak KiB of the process, and no counts: ties are broken otherwise. CELLS gets the corners of each cell, of 32 bits.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include <geogram/basic/command_line.h>
#include <geogram/basic/command_line_args.h>
#include <geogram/basic/common.h>
#include <geogram/basic/process.h>
#include <geogram/delaunay/delaunay.h>
#include <geogram/delaunay/delaunay_3d.h>
#include <geogram/delaunay/parallel_delaunay_3d.h>

int main(int given, char **arguments) {
  GEO::initialize();
  GEO::CmdLine::import_arg_group("standard");
  GEO::CmdLine::import_arg_group("algo");
  const int threads = std::atoi(arguments[2]);
  GEO::Process::enable_multithreading(threads > 1);
  GEO::Process::set_max_threads(threads);

  std::vector<double> rows;
  std::FILE *file = std::fopen(arguments[1], "rb");
  double q[4];
  while (file && std::fread(q, sizeof q, 1, file) == 1) rows.insert(rows.end(), q, q + 4);
  const std::size_t count = rows.size() / 4;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t i = 0; i < count; ++i) {
    least = std::min(least, rows[4 * i + 3]);
    most = std::max(most, rows[4 * i + 3]);
  }
  const GEO::coord_index_t dimension = least < most ? 4 : 3;
  std::vector<double> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.insert(points.end(), &rows[4 * i], &rows[4 * i + 3]);
    if (dimension == 4) points.push_back(std::sqrt(most - rows[4 * i + 3]));
  }

  const auto start = std::chrono::steady_clock::now();
  GEO::Delaunay_var delaunay;
  if (threads > 1) {
    delaunay = new GEO::ParallelDelaunay3d(dimension);
  } else if (dimension == 4) {
    delaunay = new GEO::RegularWeightedDelaunay3d(dimension);
  } else {
    delaunay = new GEO::Delaunay3d(dimension);
  }
  delaunay->set_keeps_infinite(false);
  delaunay->set_vertices(GEO::index_t(count), points.data());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (delaunay->nb_cells() == 0) return 1;
  if (given > 3) {
    std::FILE *to = std::fopen(arguments[3], "wb");
    for (GEO::index_t cell = 0; to && cell < delaunay->nb_cells(); ++cell) {
      for (GEO::index_t i = 0; i < 4; ++i) {
        const unsigned corner = unsigned(delaunay->cell_vertex(cell, i));
        std::fwrite(&corner, sizeof corner, 1, to);
      }
    }
    if (!to || std::fclose(to) != 0) return 1;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%.4f %ld\n", seconds.count(), usage.ru_maxrss);
  std::fflush(stdout);
  // Destructors are not part of the race.
  std::_Exit(0);
}
