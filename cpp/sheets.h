// Union-find over the corners of cells, by which the outside of a shape is told into sheets.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace walpha {

// A corner is a cell seen from one of its vertices: 4·cell + place. Corners of exterior cells that
// meet at a vertex through an exterior facet lie in one sector of the space around that vertex;
// all that a side of a boundary facet has, and those at both ends of a singular edge, lie on one
// sheet.
class Sheets {
 public:
  explicit Sheets(std::uint32_t cells) : parent_(4 * std::size_t{cells}) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  std::uint32_t find(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a < b) {
      parent_[b] = a;
    } else {
      parent_[a] = b;
    }
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace walpha
