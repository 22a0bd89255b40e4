#include "walpha/cpp/slab.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "walpha/cpp/bridge.h"
#include "walpha/cpp/classes.h"
#include "walpha/cpp/mesh.h"
#include "walpha/cpp/predicates.h"
#include "walpha/src/cgal/ffi.rs.h"

namespace walpha {
namespace {

// Whether (a, b, c, d), a permutation of 0..3, is even.
bool even(int a, int b, int c, int d) {
  return ((a > b) + (a > c) + (a > d) + (b > c) + (b > d) + (c > d)) % 2 == 0;
}

// The two places of a cell besides two others.
std::pair<int, int> others(int k, int j) {
  static constexpr int FIRST[4][4] = {{0, 2, 1, 1}, {2, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}};
  const int first = FIRST[k][j];
  return {first, 6 - k - j - first};
}

class Classifier {
 public:
  Classifier(const std::vector<Site> &sites, const Mesh &mesh, const Predicates &predicates,
             rust::Slice<const std::uint32_t> input, rust::Slice<const std::uint8_t> owned,
             bool everything, bool exterior, Slab &slab)
      : sites_(sites), mesh_(mesh), predicates_(predicates), input_(input), owned_(owned),
        everything_(everything), exterior_(exterior), slab_(slab), state_(mesh.cells()),
        parent_(4 * std::size_t{mesh.cells()}), slot_(sites.size(), Mesh::NONE),
        place_(mesh.cells(), Mesh::NONE) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  void run() {
    classify_cells();
    classify_facets();
    for (std::uint32_t v = 0; v < sites_.size(); ++v) {
      if (owned_[v]) around(v);
    }
    number_sheets();
  }

 private:
  // A neighbour of the point in hand, with what the cells around their edge say.
  struct Edge {
    std::uint32_t to;
    bool any, all;  // facets in the shape: at least one, and all finite ones interior
    Class edge_class;
  };

  const Site &site(std::uint32_t v) const { return sites_[v]; }

  // What is known of a cell: the classes of its facets, two bits each, and two flags.
  static constexpr std::uint16_t INSIDE = 0x100, INFINITE = 0x200;

  bool inside(std::uint32_t cell) const { return state_[cell] & INSIDE; }
  bool infinite(std::uint32_t cell) const { return state_[cell] & INFINITE; }
  Class facet(std::uint32_t cell, int opposite) const {
    return static_cast<Class>(state_[cell] >> (2 * opposite) & 3);
  }

  void classify_cells() {
    for (std::uint32_t c = 0; c < mesh_.cells(); ++c) {
      const std::uint32_t *v = mesh_.vertices(c);
      if (std::find(v, v + 4, mesh_.infinite()) != v + 4) {
        state_[c] = INFINITE;
      } else if (everything_ ||
                 predicates_.fits(site(v[0]), site(v[1]), site(v[2]), site(v[3]))) {
        state_[c] = INSIDE;
      }
    }
  }

  void classify_facets() {
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
      }
    }
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

  // Everything at one owned point: its class, the simplices it is the smallest vertex of, and the
  // sectors into which the shape divides the space around it.
  void around(std::uint32_t v) {
    const Mesh::Star star = mesh_.star(v);
    if (star.first == star.last) {
      slab_.vertex_classes_.push_back(HIDDEN);
      slab_.counts_.insert(slab_.counts_.end(), {0, 0, 0});
      return;
    }
    const auto in = [&](std::uint32_t at) { return inside(at / 4); };
    const bool interior = std::all_of(star.begin(), star.end(), in);
    find_edges(v, star, interior);
    const Class vertex_class = interior ? INTERIOR : classify_vertex(v);
    slab_.vertex_classes_.push_back(vertex_class);
    emit_cells(v);
    emit_facets(v, star);
    emit_edges(v);
    if (vertex_class == REGULAR) join_sectors(v, star);
    for (const Edge &edge : neighbours_) slot_[edge.to] = Mesh::NONE;
  }

  void find_edges(std::uint32_t v, Mesh::Star star, bool interior) {
    neighbours_.clear();
    for (const std::uint32_t at : star) {
      const std::uint32_t c = at / 4;
      const int k = at & 3;
      const std::uint32_t *vertex = mesh_.vertices(c);
      for (int j = 0; j < 4; ++j) {
        const std::uint32_t u = vertex[j];
        if (j == k || u == mesh_.infinite()) continue;
        if (slot_[u] == Mesh::NONE) {
          slot_[u] = static_cast<std::uint32_t>(neighbours_.size());
          neighbours_.push_back({u, false, true, INTERIOR});
        }
        if (interior) continue;
        Edge &edge = neighbours_[slot_[u]];
        const auto [a, b] = others(k, j);
        for (const auto &[opposite, third] : {std::pair{a, b}, std::pair{b, a}}) {
          if (vertex[third] == mesh_.infinite()) continue;
          const Class facet_class = facet(c, opposite);
          edge.any |= facet_class != EXTERIOR;
          edge.all &= facet_class == INTERIOR;
        }
      }
    }
    if (interior) return;
    for (Edge &edge : neighbours_) {
      edge.edge_class = edge.all ? INTERIOR : edge.any ? REGULAR : lone_edge(v, edge.to, star);
    }
  }

  Class lone_edge(std::uint32_t v, std::uint32_t u, Mesh::Star star) const {
    if (!predicates_.fits(site(v), site(u))) return EXTERIOR;
    for (const std::uint32_t at : star) {
      const std::uint32_t *vertex = mesh_.vertices(at / 4);
      const std::uint32_t *end = vertex + 4;
      if (std::find(vertex, end, u) == end) continue;
      for (const std::uint32_t *x = vertex; x != end; ++x) {
        if (*x == u || *x == v || *x == mesh_.infinite()) continue;
        if (predicates_.inside(site(v), site(u), site(*x))) return EXTERIOR;
      }
    }
    return SINGULAR;
  }

  // The class of a point that is not interior.
  Class classify_vertex(std::uint32_t v) const {
    const auto there = [](const Edge &edge) { return edge.edge_class != EXTERIOR; };
    if (std::any_of(neighbours_.begin(), neighbours_.end(), there)) return REGULAR;
    if (!everything_ && !predicates_.fits(site(v))) return EXTERIOR;
    const auto hides = [&](const Edge &edge) { return predicates_.inside(site(v), site(edge.to)); };
    return std::any_of(neighbours_.begin(), neighbours_.end(), hides) ? EXTERIOR : SINGULAR;
  }

  void emit_cells(std::uint32_t v) {
    rows_.clear();
    for (std::uint32_t c = mesh_.first_cell(v); c < mesh_.first_cell(v + 1); ++c) {
      if ((!inside(c) && !exterior_) || infinite(c)) continue;
      const std::uint32_t *vertex = mesh_.vertices(c);
      std::array<int, 4> order{0, 1, 2, 3};
      std::sort(order.begin(), order.end(), [&](int a, int b) { return vertex[a] < vertex[b]; });
      if (!even(order[0], order[1], order[2], order[3])) std::swap(order[2], order[3]);
      rows_.push_back({vertex[order[1]], vertex[order[2]], vertex[order[3]],
                       inside(c) ? INTERIOR : EXTERIOR, {}});
    }
    std::sort(rows_.begin(), rows_.end());
    for (const Row &row : rows_) {
      append(slab_.cells_, {v, row.a, row.b, row.c});
      slab_.cell_classes_.push_back(row.row_class);
    }
    slab_.counts_.push_back(static_cast<std::uint32_t>(rows_.size()));
  }

  void emit_facets(std::uint32_t v, Mesh::Star star) {
    rows_.clear();
    for (const std::uint32_t at : star) {
      const std::uint32_t c = at / 4;
      const int k = at & 3;
      const std::uint32_t *vertex = mesh_.vertices(c), *next = mesh_.neighbours(c);
      for (int j = 0; j < 4; ++j) {
        if (j == k || next[j] < c) continue;
        auto [p, q] = others(k, j);
        if (vertex[p] > vertex[q]) std::swap(p, q);
        // The infinite vertex has the largest number, so this leaves infinite facets out, too.
        if (vertex[p] < v || vertex[q] == mesh_.infinite()) continue;
        const Class facet_class = facet(c, j);
        if (facet_class == EXTERIOR && !exterior_) continue;
        // (v, p, q) turns counter-clockwise seen from the fourth vertex if the order is even.
        const bool clockwise_here = !even(k, p, q, j);
        Row row{vertex[p], vertex[q], 0, facet_class, {}};
        const std::uint32_t here = 4 * c + j, there = 4 * next[j] + mesh_.mirror(c, j);
        if (facet_class == REGULAR) {
          if (clockwise_here != static_cast<bool>(inside(c))) std::swap(row.a, row.b);
          row.nodes = {inside(c) ? there : here, Mesh::NONE};
        } else if (facet_class == SINGULAR) {
          row.nodes = clockwise_here ? std::array{here, there} : std::array{there, here};
        }
        rows_.push_back(row);
      }
    }
    std::sort(rows_.begin(), rows_.end());
    for (const Row &row : rows_) {
      append(slab_.facets_, {v, row.a, row.b});
      slab_.facet_classes_.push_back(row.row_class);
      if (row.row_class == REGULAR) slab_.facet_sheets_.push_back(row.nodes[0]);
      if (row.row_class == SINGULAR) {
        slab_.facet_sheets_.insert(slab_.facet_sheets_.end(), row.nodes.begin(), row.nodes.end());
      }
    }
    slab_.counts_.push_back(static_cast<std::uint32_t>(rows_.size()));
  }

  void emit_edges(std::uint32_t v) {
    rows_.clear();
    for (const Edge &edge : neighbours_) {
      if (edge.to < v || (edge.edge_class == EXTERIOR && !exterior_)) continue;
      rows_.push_back({edge.to, 0, 0, edge.edge_class, {}});
    }
    std::sort(rows_.begin(), rows_.end());
    for (const Row &row : rows_) {
      append(slab_.edges_, {v, row.a});
      slab_.edge_classes_.push_back(row.row_class);
      if (row.row_class == SINGULAR) slab_.edge_sheets_.push_back(edge_node(v, row.a));
    }
    slab_.counts_.push_back(static_cast<std::uint32_t>(rows_.size()));
  }

  // Walks the exterior cells at v that hang together through exterior facets at v, and joins the
  // sides of facets and the singular edges that they touch: all lie on one sheet.
  void join_sectors(std::uint32_t v, Mesh::Star star) {
    for (const std::uint32_t at : star) place_[at / 4] = at & 3;
    for (const std::uint32_t at : star) {
      if (inside(at / 4) || place_[at / 4] == Mesh::NONE) continue;
      std::uint32_t first = Mesh::NONE;
      const auto touch = [&](std::uint32_t node) {
        if (first == Mesh::NONE) first = node;
        unite(first, node);
      };
      walk_.assign(1, at);
      place_[at / 4] = Mesh::NONE;
      while (!walk_.empty()) {
        const std::uint32_t c = walk_.back() / 4;
        const int k = walk_.back() & 3;
        walk_.pop_back();
        const std::uint32_t *vertex = mesh_.vertices(c), *next = mesh_.neighbours(c);
        for (int j = 0; j < 4; ++j) {
          if (j == k) continue;
          if (vertex[j] != mesh_.infinite() &&
              neighbours_[slot_[vertex[j]]].edge_class == SINGULAR) {
            touch(edge_node(v, vertex[j]));
          }
          if (facet(c, j) != EXTERIOR) {
            touch(4 * c + j);
            share(v, c, j, k);
          } else if (place_[next[j]] != Mesh::NONE) {
            walk_.push_back(4 * next[j] + place_[next[j]]);
            place_[next[j]] = Mesh::NONE;
          }
        }
      }
    }
    for (const std::uint32_t at : star) place_[at / 4] = Mesh::NONE;
  }

  // Notes the side of a facet that other slabs know, too.
  void share(std::uint32_t v, std::uint32_t c, int j, int k) {
    const std::uint32_t *vertex = mesh_.vertices(c);
    const auto [p, q] = others(k, j);
    const bool mixed = !owned_[vertex[p]] || !owned_[vertex[q]];
    if (!mixed || (owned_[vertex[p]] && vertex[p] < v) || (owned_[vertex[q]] && vertex[q] < v)) {
      return;  // the slab's own, or noted at another of its points
    }
    std::array<int, 3> order{k, p, q};
    std::sort(order.begin(), order.end(), [&](int a, int b) { return vertex[a] < vertex[b]; });
    const std::uint32_t side = even(order[0], order[1], order[2], j) ? 1 : 0;
    append(slab_.shared_, {input_[vertex[order[0]]], input_[vertex[order[1]]],
                           input_[vertex[order[2]]], side, 4 * c + static_cast<std::uint32_t>(j)});
  }

  std::uint32_t edge_node(std::uint32_t v, std::uint32_t u) {
    const auto [low, high] = std::minmax(v, u);
    const auto node = static_cast<std::uint32_t>(parent_.size());
    const auto [found, fresh] = edge_nodes_.emplace(std::uint64_t{low} << 32 | high, node);
    if (fresh) {
      parent_.push_back(node);
      if (!owned_[u]) {
        append(slab_.shared_, {input_[low], input_[high], input_[high], 0, node});
      }
    }
    return found->second;
  }

  std::uint32_t find(std::uint32_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  // Replaces nodes by the numbers of their sheets, from 0 in order of appearance.
  void number_sheets() {
    std::vector<std::uint32_t> sheet(parent_.size(), Mesh::NONE);
    const auto number = [&](std::uint32_t &node) {
      std::uint32_t &name = sheet[find(node)];
      if (name == Mesh::NONE) name = slab_.sheets_++;
      node = name;
    };
    for (std::uint32_t &node : slab_.facet_sheets_) number(node);
    for (std::uint32_t &node : slab_.edge_sheets_) number(node);
    for (std::size_t i = 4; i < slab_.shared_.size(); i += 5) number(slab_.shared_[i]);
  }

  static void append(std::vector<std::uint32_t> &to, std::initializer_list<std::uint32_t> row) {
    for (const std::uint32_t number : row) to.push_back(number);
  }

  // The vertices of a simplex after its smallest, and the sheet nodes at its sides.
  struct Row {
    std::uint32_t a, b, c;
    Class row_class;
    std::array<std::uint32_t, 2> nodes;

    bool operator<(const Row &o) const {
      return a != o.a ? a < o.a : b != o.b ? b < o.b : c < o.c;
    }
  };

  const std::vector<Site> &sites_;
  const Mesh &mesh_;
  const Predicates &predicates_;
  rust::Slice<const std::uint32_t> input_;
  rust::Slice<const std::uint8_t> owned_;
  bool everything_, exterior_;
  Slab &slab_;
  std::vector<std::uint16_t> state_;      // by cell
  std::vector<std::uint32_t> parent_;     // union-find over nodes: 4·cell + facet, then edges
  std::vector<std::uint32_t> slot_;       // by site: its place in neighbours_
  std::vector<std::uint32_t> place_;      // by cell: place of the point in hand, until walked
  std::vector<std::uint32_t> walk_;
  std::vector<Edge> neighbours_;
  std::vector<Row> rows_;
  std::unordered_map<std::uint64_t, std::uint32_t> edge_nodes_;
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
  const Mesh mesh(sites, owned.data(), lattice);
  result->dimension_ = mesh.dimension();
  if (mesh.dimension() != 3) return result;
  const Predicates predicates(question.alpha, lattice);
  const bool everything = std::isinf(question.alpha);
  Classifier(sites, mesh, predicates, input, owned, everything, question.exterior, *result).run();
  for (auto *rows : {&result->cells_, &result->facets_, &result->edges_}) {
    for (std::uint32_t &v : *rows) v = input[v];
  }
  return result;
}

}  // namespace walpha
