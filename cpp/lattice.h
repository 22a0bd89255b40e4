// When plain double arithmetic is exact.
#pragma once

#include <cmath>

namespace walpha {

// A step, a power of two, of which all coordinates of a set are integer multiples; perhaps all
// weights are multiples of its square, too. A polynomial of degree k in coordinate differences
// (weights count as degree 2) whose terms stay below 2⁵³ stepᵏ in sum of magnitudes is then
// computed without any rounding. On voxel grids that decides every tie; without it, each of the
// many cospherical and coplanar tuples there would go to rational arithmetic.
class Lattice {
 public:
  // No two numbers are known to have anything in common.
  Lattice() = default;
  Lattice(double step, bool holds_weights) : step_(step), holds_weights_(holds_weights) {}

  // Whether all weights are multiples of the squared step.
  bool holds_weights() const { return holds_weights_; }

  // Whether `weight` is one.
  bool holds(double weight) const {
    const double multiple = weight / (step_ * step_);
    return step_ != 0 && std::abs(multiple) < 0x1p53 && std::nearbyint(multiple) == multiple;
  }

  // Whether doubles hold a polynomial of this degree whose terms sum to `bound` in magnitude.
  template <int Degree>
  bool exact(double bound) const {
    double unit = 1;
    for (int i = 0; i < Degree; ++i) unit *= step_;
    // Without a step nothing is, not even a bound that underflowed to 0.
    return step_ != 0 && bound <= 0x1p53 * unit;
  }

 private:
  double step_ = 0;
  bool holds_weights_ = false;
};

}  // namespace walpha
