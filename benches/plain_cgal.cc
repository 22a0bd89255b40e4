// What a CGAL user writes: one triangulation, one Fixed_alpha_shape_3, and one pass over each kind of
// simplex that copies input indices and classes. The baseline of benches/race, which compiles it
// with -O3 -DNDEBUG, and once more with CGAL_LINKED_WITH_TBB: then the triangulation is CGAL's parallel one.
//
//   plain_cgal POINTS ALPHA THREADS                   POINTS: x, y, z, ω of each point as little-endian doubles
//   plain_cgal POINTS triangulation THREADS [CELLS]   the triangulation alone; CELLS gets the corners of each cell, of 32 bits
//
// Prints seconds, peak KiB of the process, and the simplices of the shape by dimension and class:
// cells, then interior, regular, singular facets, edges, vertices.
#include <sys/resource.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Fixed_alpha_shape_3.h>
#include <CGAL/Fixed_alpha_shape_cell_base_3.h>
#include <CGAL/Fixed_alpha_shape_vertex_base_3.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/Bbox_3.h>
#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
using Concurrency = CGAL::Parallel_tag;
#else
using Concurrency = CGAL::Sequential_tag;
#endif

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Regular_vertex = CGAL::Regular_triangulation_vertex_base_3<Kernel>;
using Numbered = CGAL::Triangulation_vertex_base_with_info_3<unsigned, Kernel, Regular_vertex>;
using Vertex = CGAL::Fixed_alpha_shape_vertex_base_3<Kernel, Numbered>;
using Cell = CGAL::Fixed_alpha_shape_cell_base_3<Kernel, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Triangulation =
    CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell, Concurrency>>;
using Shape = CGAL::Fixed_alpha_shape_3<Triangulation>;

template <std::size_t N>
struct Simplices {
  std::vector<std::array<unsigned, N>> vertices;
  std::vector<char> classes;

  void push(const std::array<unsigned, N> &row, Shape::Classification_type type) {
    if (type == Shape::EXTERIOR) return;
    vertices.push_back(row);
    classes.push_back(static_cast<char>(type));
  }
  void print() const {
    for (const auto type : {Shape::INTERIOR, Shape::REGULAR, Shape::SINGULAR}) {
      std::printf(" %td", std::count(classes.begin(), classes.end(), static_cast<char>(type)));
    }
  }
};

int main(int count, char **arguments) {
  std::vector<std::pair<Triangulation::Weighted_point, unsigned>> points;
  std::FILE *file = std::fopen(arguments[1], "rb");
  double q[4];
  while (file && std::fread(q, sizeof q, 1, file) == 1) {
    points.emplace_back(Triangulation::Weighted_point({q[0], q[1], q[2]}, q[3]), points.size());
  }
  Simplices<4> cells;
  Simplices<3> facets;
  Simplices<2> edges;
  Simplices<1> vertices;
#ifdef CGAL_LINKED_WITH_TBB
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    std::atoi(arguments[3]));
#endif
  const auto start = std::chrono::steady_clock::now();
#ifdef CGAL_LINKED_WITH_TBB
  // A grid of locks over the points, as CGAL's manual has it.
  CGAL::Bbox_3 box;
  for (const auto &point : points) box += point.first.bbox();
  Triangulation::Lock_data_structure locks(box, 50);
  Triangulation triangulation(points.begin(), points.end(), &locks);
#else
  Triangulation triangulation(points.begin(), points.end());
#endif
  if (std::strcmp(arguments[2], "triangulation") != 0) {
    const Shape shape(triangulation, std::atof(arguments[2]));
    for (auto c = shape.finite_cells_begin(); c != shape.finite_cells_end(); ++c) {
      cells.push({c->vertex(0)->info(), c->vertex(1)->info(), c->vertex(2)->info(),
                  c->vertex(3)->info()},
                 shape.classify(Shape::Cell_handle(c)));
    }
    for (auto f = shape.finite_facets_begin(); f != shape.finite_facets_end(); ++f) {
      const auto vertex = [&](int i) { return f->first->vertex((f->second + i) & 3)->info(); };
      facets.push({vertex(1), vertex(2), vertex(3)}, shape.classify(*f));
    }
    for (auto e = shape.finite_edges_begin(); e != shape.finite_edges_end(); ++e) {
      edges.push({e->first->vertex(e->second)->info(), e->first->vertex(e->third)->info()},
                 shape.classify(*e));
    }
    for (auto v = shape.finite_vertices_begin(); v != shape.finite_vertices_end(); ++v) {
      vertices.push({v->info()}, shape.classify(Shape::Vertex_handle(v)));
    }
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (count > 4) {
    std::FILE *to = std::fopen(arguments[4], "wb");
    for (auto c = triangulation.finite_cells_begin(); to && c != triangulation.finite_cells_end(); ++c) {
      for (int i = 0; i < 4; ++i) std::fwrite(&c->vertex(i)->info(), sizeof(unsigned), 1, to);
    }
    if (!to || std::fclose(to) != 0) return 1;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%.4f %ld %zu", seconds.count(), usage.ru_maxrss, cells.classes.size());
  facets.print();
  edges.print();
  vertices.print();
  std::printf("\n");
  std::fflush(stdout);
  // Destructors are not part of the race.
  std::_Exit(0);
}
