#include "walpha/cpp/slab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "walpha/cpp/bridge.h"
#include "walpha/cpp/classes.h"
#include "walpha/cpp/mesh.h"
#include "walpha/cpp/predicates.h"
#include "walpha/cpp/sheets.h"
#include "walpha/src/cgal/ffi.rs.h"

namespace walpha {
namespace {

// Whether a permutation of 0..3 that begins with a, b, c is even.
constexpr bool even(int a, int b, int c) {
  const int d = 6 - a - b - c;
  return ((a > b) + (a > c) + (a > d) + (b > c) + (b > d) + (c > d)) % 2 == 0;
}

class Classifier {
 public:
  Classifier(const std::vector<Site> &sites, const Mesh &mesh, const Predicates &predicates,
             const std::uint32_t *input, const std::uint8_t *owned, bool everything, bool exterior,
             Slab &slab)
      : sites_(sites), mesh_(mesh), predicates_(predicates), input_(input), owned_(owned),
        everything_(everything), exterior_(exterior), slab_(slab), state_(mesh.cells()),
        sheets_(mesh.cells()), slot_(sites.size(), Mesh::NONE) {}

  void run() {
    classify_cells();
    classify_facets();
    for (std::uint32_t v = 0; v < sites_.size(); ++v) {
      if (owned_[v]) around(v);
    }
    number_sheets();
  }

 private:
  // A neighbour of the point in hand, with what the facets at their edge say.
  struct Edge {
    std::uint32_t to;
    std::uint32_t corner;  // of a singular edge, at the point in hand
    bool any, open;        // of the facets: one is in the shape, one is not interior
  };

  // The vertices of a simplex after its smallest, in order, and what else is to be known of it.
  struct Row {
    std::uint64_t first_two;
    std::uint32_t third, data;

    Row() = default;
    Row(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t more)
        : first_two(std::uint64_t{a} << 32 | b), third(c), data(more) {}
    std::uint32_t a() const { return static_cast<std::uint32_t>(first_two >> 32); }
    std::uint32_t b() const { return static_cast<std::uint32_t>(first_two); }
    bool operator<(const Row &o) const {
      return first_two != o.first_two ? first_two < o.first_two : third < o.third;
    }
  };

  const Site &site(std::uint32_t v) const { return sites_[v]; }

  // What is known of a cell: the classes of its facets, two bits each, two flags, and which of its
  // facets it is to give out, a bit each.
  static constexpr std::uint16_t INSIDE = 0x100, INFINITE = 0x200;
  static constexpr int GIVES = 12;

  bool inside(std::uint32_t cell) const { return state_[cell] & INSIDE; }
  bool infinite(std::uint32_t cell) const { return state_[cell] & INFINITE; }
  Class facet(std::uint32_t cell, int opposite) const {
    return static_cast<Class>(state_[cell] >> (2 * opposite) & 3);
  }

  void classify_cells() {
    std::size_t count = 0;
    for (std::uint32_t c = 0; c < mesh_.cells(); ++c) {
      const std::uint32_t *v = mesh_.vertices(c);
      if (std::find(v, v + 4, mesh_.infinite()) != v + 4) {
        state_[c] = INFINITE;
      } else if (everything_ ||
                 predicates_.fits(site(v[0]), site(v[1]), site(v[2]), site(v[3]))) {
        state_[c] = INSIDE;
        ++count;
      }
    }
    slab_.cells_.reserve(3 * count);
    slab_.cell_classes_.reserve(count);
  }

  void classify_facets() {
    std::size_t facets = 0;
    for (std::uint32_t c = 0; c < mesh_.cells(); ++c) {
      const std::uint32_t *next = mesh_.neighbours(c);
      for (int i = 0; i < 4; ++i) {
        const std::uint32_t n = next[i];
        // Each pair once; a neighbour out of reach shares no owned point, so nobody will ask.
        if (n == Mesh::NONE || n < c) continue;
        const int j = mesh_.mirror(c, i);
        const Class facet_class = classify_facet(c, i, n, j);
        state_[c] |= static_cast<std::uint16_t>(facet_class << (2 * i));
        state_[n] |= static_cast<std::uint16_t>(facet_class << (2 * j));
        if (facet_class != EXTERIOR || (exterior_ && finite(c, i))) {
          // One of the two cells at a finite facet is finite.
          (infinite(c) ? state_[n] : state_[c]) |=
              static_cast<std::uint16_t>(1 << (GIVES + (infinite(c) ? j : i)));
          ++facets;
        }
        if (facet_class == EXTERIOR) {
          pass(c, i, n, j);
        } else if (facet_class != INTERIOR) {
          if (!inside(c)) join_side(c, i);
          if (!inside(n)) join_side(n, j);
        }
      }
    }
    slab_.facets_.reserve(2 * facets);
    slab_.facet_classes_.reserve(facets);
  }

  bool finite(std::uint32_t c, int opposite) const {
    return !infinite(c) || mesh_.vertices(c)[opposite] == mesh_.infinite();
  }

  Class classify_facet(std::uint32_t c, int i, std::uint32_t n, int j) const {
    if (inside(c) && inside(n)) return INTERIOR;
    if (inside(c) || inside(n)) return REGULAR;
    const std::uint32_t *v = mesh_.vertices(c), beyond = mesh_.vertices(n)[j];
    const std::uint32_t a = v[(i + 1) & 3], b = v[(i + 2) & 3], d = v[(i + 3) & 3];
    const std::uint32_t none = mesh_.infinite();
    if (a == none || b == none || d == none) return EXTERIOR;
    if (!predicates_.fits(site(a), site(b), site(d))) return EXTERIOR;
    // In a regular triangulation a sphere that holds a point holds one of the two beside it.
    for (const std::uint32_t x : {v[i], beyond}) {
      if (x != none && predicates_.inside(site(a), site(b), site(d), site(x))) return EXTERIOR;
    }
    return SINGULAR;
  }

  bool owned(std::uint32_t v) const { return v != mesh_.infinite() && owned_[v]; }

  // Around each owned vertex of an exterior facet, the cells on both sides are in one sector. At
  // other points not all is known here; the slabs that own them will say.
  void pass(std::uint32_t c, int i, std::uint32_t n, int j) {
    const std::uint32_t *v = mesh_.vertices(c), *w = mesh_.vertices(n);
    for (int k = 0; k < 4; ++k) {
      if (k == i || !owned(v[k])) continue;
      int m = (j + 1) & 3;
      while (w[m] != v[k]) m = (m + 1) & 3;
      sheets_.unite(4 * c + k, 4 * n + m);
    }
  }

  // A corner of an exterior cell on the side it has of a facet.
  std::uint32_t corner(std::uint32_t c, int opposite) const {
    int k = (opposite + 1) & 3;
    while (!owned_[mesh_.vertices(c)[k]]) k = (k + 1) & 3;
    return 4 * c + k;
  }

  // One side of a boundary facet is on one sheet; other slabs may know it too.
  void join_side(std::uint32_t c, int opposite) {
    const std::uint32_t *v = mesh_.vertices(c);
    std::array<int, 3> order{};
    int count = 0, foreign = 0;
    for (int k = 0; k < 4; ++k) {
      if (k == opposite) continue;
      order[count++] = k;
      foreign += !owned_[v[k]];
    }
    if (foreign == 3) return;  // seen across from two owned points, and not known well here
    const std::uint32_t first = corner(c, opposite);
    for (const int k : order) {
      if (owned_[v[k]]) sheets_.unite(first, 4 * c + k);
    }
    if (foreign == 0) return;
    std::sort(order.begin(), order.end(), [&](int a, int b) { return v[a] < v[b]; });
    const std::uint32_t side = even(order[0], order[1], order[2]) ? 1 : 0;
    share({v[order[0]], v[order[1]], v[order[2]]}, side, first);
  }

  void share(std::array<std::uint32_t, 3> v, std::uint32_t side, std::uint32_t corner) {
    append(slab_.shared_, {input_[v[0]], input_[v[1]], input_[v[2]], side, corner});
  }

  // Everything at one owned point: its class, and the simplices it is the smallest vertex of.
  void around(std::uint32_t v) {
    const Mesh::Star star = mesh_.star(v);
    if (star.first == star.last) {
      slab_.vertex_classes_.push_back(HIDDEN);
      append(slab_.counts_, {0, 0, 0});
      return;
    }
    emit_cells(v);
    const bool covered = meet(v, star);
    emit_facets(v);
    emit_edges(v, star);
    const auto in = [&](std::uint32_t at) { return inside(at / 4); };
    slab_.vertex_classes_.push_back(std::all_of(star.begin(), star.end(), in) ? INTERIOR
                                    : covered ? REGULAR : lone_vertex(v, star));
    for (const Edge &edge : neighbours_) slot_[edge.to] = Mesh::NONE;
  }

  void emit_cells(std::uint32_t v) {
    rows_.clear();
    for (std::uint32_t c = mesh_.first_cell(v); c < mesh_.first_cell(v + 1); ++c) {
      if ((!inside(c) && !exterior_) || infinite(c)) continue;
      const std::uint32_t *vertex = mesh_.vertices(c);
      const int k = static_cast<int>(std::find(vertex, vertex + 4, v) - vertex);
      std::array<std::uint32_t, 3> row{vertex[(k + 1) & 3], vertex[(k + 2) & 3],
                                       vertex[(k + 3) & 3]};
      // Rotating a row of four is odd, and so is each exchange.
      bool odd = k & 1;
      const auto order = [&](int a, int b) {
        if (row[a] < row[b]) return;
        std::swap(row[a], row[b]);
        odd = !odd;
      };
      order(0, 1);
      order(1, 2);
      order(0, 1);
      if (odd) std::swap(row[1], row[2]);
      rows_.emplace_back(row[0], row[1], row[2], inside(c) ? INTERIOR : EXTERIOR);
    }
    std::sort(rows_.begin(), rows_.end());
    for (const Row &row : rows_) {
      append(slab_.cells_, {row.a(), row.b(), row.third});
      slab_.cell_classes_.push_back(static_cast<std::uint8_t>(row.data));
    }
    slab_.counts_.push_back(static_cast<std::uint32_t>(rows_.size()));
  }

  // One walk around the point, nearly without branches: its neighbours with what the facets say of
  // the edges to them, and the facets that it is the smallest vertex of. Gives whether one of the
  // facets around it is in the shape.
  bool meet(std::uint32_t v, Mesh::Star star) {
    neighbours_.clear();
    rows_.resize(3 * static_cast<std::size_t>(star.end() - star.begin()));
    Row *row = rows_.data();
    unsigned covered = 0;
    for (const std::uint32_t at : star) {
      const std::uint32_t c = at / 4;
      const unsigned state = state_[c];
      if (state & INFINITE) continue;
      // A bit for each facet that is in the shape, for each that is not interior.
      const unsigned there = (state | state >> 1) & 0x55, open = (state >> 1 | ~state) & 0x55;
      const std::uint32_t *vertex = mesh_.vertices(c);
      const unsigned i = (at + 1) & 3, j = (at + 2) & 3, k = (at + 3) & 3;
      const std::uint32_t a = vertex[i], b = vertex[j], d = vertex[k];
      const unsigned across_i = 1u << 2 * i, across_j = 1u << 2 * j, across_k = 1u << 2 * k;
      covered |= there & (across_i | across_j | across_k);
      const auto see = [&](std::uint32_t u, unsigned facets) {
        Edge &edge = neighbour(u);
        edge.any |= (there & facets) != 0;
        edge.open |= (open & facets) != 0;
      };
      see(a, across_j | across_k);
      see(b, across_k | across_i);
      see(d, across_i | across_j);
      const auto give = [&](std::uint32_t p, std::uint32_t q, unsigned opposite) {
        const auto [low, high] = std::minmax(p, q);
        *row = {low, high, 0, 4 * c + opposite};
        row += (low > v) & (state >> (GIVES + opposite));
      };
      give(b, d, i);
      give(a, d, j);
      give(a, b, k);
    }
    rows_.resize(static_cast<std::size_t>(row - rows_.data()));
    return covered != 0;
  }

  Edge &neighbour(std::uint32_t u) {
    std::uint32_t &slot = slot_[u];
    if (slot == Mesh::NONE) {
      slot = static_cast<std::uint32_t>(neighbours_.size());
      neighbours_.push_back({u, Mesh::NONE, false, false});
    }
    return neighbours_[slot];
  }

  void emit_facets(std::uint32_t v) {
    for (Row &row : rows_) {
      const std::uint32_t c = row.data / 4;
      if (facet(c, row.data & 3) != REGULAR) continue;
      if (clockwise(c, v, row.a(), row.b()) != inside(c)) row = {row.b(), row.a(), 0, row.data};
    }
    std::sort(rows_.begin(), rows_.end());
    for (const Row &row : rows_) emit_facet(v, row);
    slab_.counts_.push_back(static_cast<std::uint32_t>(rows_.size()));
  }

  void emit_facet(std::uint32_t v, const Row &row) {
    const std::uint32_t c = row.data / 4;
    const int j = row.data & 3;
    append(slab_.facets_, {row.a(), row.b()});
    const Class facet_class = facet(c, j);
    slab_.facet_classes_.push_back(facet_class);
    if (facet_class != REGULAR && facet_class != SINGULAR) return;
    const std::uint32_t n = mesh_.neighbours(c)[j];
    if (facet_class == REGULAR) {
      const bool beyond = inside(c);
      slab_.facet_sheets_.push_back(beyond ? corner(n, mesh_.mirror(c, j)) : corner(c, j));
    } else {
      std::array sides{corner(c, j), corner(n, mesh_.mirror(c, j))};
      if (!clockwise(c, v, row.a(), row.b())) std::swap(sides[0], sides[1]);
      append(slab_.facet_sheets_, {sides[0], sides[1]});
    }
  }

  // Whether a facet turns clockwise seen from the fourth vertex of a cell.
  bool clockwise(std::uint32_t c, std::uint32_t v, std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t *vertex = mesh_.vertices(c);
    const auto place = [&](std::uint32_t u) {
      return static_cast<int>(std::find(vertex, vertex + 4, u) - vertex);
    };
    return !even(place(v), place(a), place(b));
  }

  // An edge that no facet covers.
  Class lone_edge(std::uint32_t v, Edge &edge, Mesh::Star star) {
    const std::uint32_t u = edge.to;
    if (!predicates_.fits(site(v), site(u))) return EXTERIOR;
    for (const std::uint32_t at : star) {
      const std::uint32_t *vertex = mesh_.vertices(at / 4), *end = vertex + 4;
      const std::uint32_t *found = std::find(vertex, end, u);
      if (found == end) continue;
      for (const std::uint32_t *x = vertex; x != end; ++x) {
        if (x == found || *x == v || *x == mesh_.infinite()) continue;
        if (predicates_.inside(site(v), site(u), site(*x))) return EXTERIOR;
      }
      edge.corner = at;
    }
    return SINGULAR;
  }

  void emit_edges(std::uint32_t v, Mesh::Star star) {
    rows_.clear();
    for (Edge &edge : neighbours_) {
      if (edge.to < v && owned_[edge.to]) continue;
      const Class edge_class =
          !edge.open ? INTERIOR : edge.any ? REGULAR : lone_edge(v, edge, star);
      if (edge_class == SINGULAR) join_ends(v, edge);
      if (edge.to < v || (edge_class == EXTERIOR && !exterior_)) continue;
      rows_.emplace_back(edge.to, edge.corner, 0, edge_class);
    }
    std::sort(rows_.begin(), rows_.end());
    for (const Row &row : rows_) {
      slab_.edges_.push_back(row.a());
      slab_.edge_classes_.push_back(static_cast<std::uint8_t>(row.data));
      if (row.data == SINGULAR) slab_.edge_sheets_.push_back(row.b());
    }
    slab_.counts_.push_back(static_cast<std::uint32_t>(rows_.size()));
  }

  // The space around a singular edge is one piece, from end to end.
  void join_ends(std::uint32_t v, const Edge &edge) {
    if (owned_[edge.to]) {
      const std::uint32_t *vertex = mesh_.vertices(edge.corner / 4);
      const auto place = std::find(vertex, vertex + 4, edge.to) - vertex;
      sheets_.unite(edge.corner, 4 * (edge.corner / 4) + static_cast<std::uint32_t>(place));
    } else {
      const auto [low, high] = std::minmax(v, edge.to);
      share({low, high, high}, 0, edge.corner);
    }
  }

  // The class of a point that no facet of the shape touches.
  Class lone_vertex(std::uint32_t v, Mesh::Star star) {
    bool hidden = false;
    for (Edge &edge : neighbours_) {
      if (lone_edge(v, edge, star) == SINGULAR) return REGULAR;
      hidden |= predicates_.inside(site(v), site(edge.to));
    }
    return !hidden && predicates_.fits(site(v)) ? SINGULAR : EXTERIOR;
  }

  // Replaces corners by the numbers of their sheets, from 0 in order of appearance.
  void number_sheets() {
    std::vector<std::uint32_t> sheet(4 * std::size_t{mesh_.cells()}, Mesh::NONE);
    const auto number = [&](std::uint32_t &corner) {
      std::uint32_t &name = sheet[sheets_.find(corner)];
      if (name == Mesh::NONE) name = slab_.sheets_++;
      corner = name;
    };
    for (std::uint32_t &corner : slab_.facet_sheets_) number(corner);
    for (std::uint32_t &corner : slab_.edge_sheets_) number(corner);
    for (std::size_t i = 4; i < slab_.shared_.size(); i += 5) number(slab_.shared_[i]);
  }

  static void append(std::vector<std::uint32_t> &to, std::initializer_list<std::uint32_t> row) {
    to.insert(to.end(), row);
  }

  const std::vector<Site> &sites_;
  const Mesh &mesh_;
  const Predicates &predicates_;
  const std::uint32_t *input_;
  const std::uint8_t *owned_;
  bool everything_, exterior_;
  Slab &slab_;
  std::vector<std::uint16_t> state_;  // by cell
  Sheets sheets_;
  std::vector<std::uint32_t> slot_;  // by site: its place in neighbours_
  std::vector<Edge> neighbours_;
  std::vector<Row> rows_;
};

}  // namespace

std::unique_ptr<Slab> slab(rust::Slice<const double> positions, rust::Slice<const double> weights,
                           rust::Slice<const std::uint32_t> input,
                           rust::Slice<const std::uint8_t> owned, const Question &question) {
  throw_quietly();
  std::vector<Site> sites;
  sites.reserve(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double *p = positions.data() + 3 * i;
    sites.push_back({p[0], p[1], p[2], weights[i]});
  }
  auto result = std::make_unique<Slab>();
  const Lattice lattice(question.step, question.on_lattice);
  const Mesh mesh(sites, owned.data(), lattice, question.frugal);
  result->dimension_ = mesh.dimension();
  if (mesh.dimension() != 3) return result;
  const Predicates predicates(question.alpha, lattice);
  const bool everything = std::isinf(question.alpha);
  Classifier(sites, mesh, predicates, input.data(), owned.data(), everything, question.exterior,
             *result)
      .run();
  for (auto *rows : {&result->cells_, &result->facets_, &result->edges_}) {
    for (std::uint32_t &v : *rows) v = input.data()[v];
    rows->shrink_to_fit();
  }
  return result;
}

}  // namespace walpha
