// From an exact number to the nearest double: CGAL's to_double cuts digits off for some of its exact
// types (Gmpq), which depend on CGAL, Boost and GMP.
#pragma once

#include <cmath>
#include <limits>
#include <utility>

#include <CGAL/number_utils.h>

namespace walpha {

// Of two equally near doubles the even one, as every operation of the processor does it; ±∞ beyond
// the range of doubles.
template <typename Number>
double nearest(const Number &number) {
  constexpr double most = std::numeric_limits<double>::max();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  // Two neighbouring doubles around the number. An interval need not be as narrow as that.
  std::pair<double, double> around = CGAL::to_interval(number);
  double &low = around.first, &high = around.second;
  if (high == infinity || low == -infinity) {
    // Half of a unit in the last place above the largest double.
    const Number beyond = Number(most) + Number(std::ldexp(1.0, 970));
    if (number >= beyond) return infinity;
    if (number <= -beyond) return -infinity;
    high = std::fmin(high, most);
    low = std::fmax(low, -most);
    if (number > Number(most)) return most;
    if (number < Number(-most)) return -most;
  }
  while (std::nextafter(low, infinity) < high) {
    double middle = low / 2 + high / 2;
    if (!(low < middle && middle < high)) middle = std::nextafter(low, infinity);
    (Number(middle) <= number ? low : high) = middle;
  }
  const Number twice = number + number, sum = Number(low) + Number(high);
  if (twice < sum || low == high) return low + 0.0;
  if (twice > sum) return high + 0.0;
  // Doubling the distance between two neighbours keeps the even one only.
  return std::remainder(low, 2 * (high - low)) == 0 ? low : high;
}

}  // namespace walpha
