// Which simplices have small orthogonal spheres, and which points lie inside them.
#pragma once

#include <algorithm>
#include <cmath>

#include "walpha/cpp/kernel.h"
#include "walpha/cpp/lattice.h"

namespace walpha {

// A weighted point as four doubles.
struct Site {
  double x, y, z, weight;

  Kernel::Weighted_point_3 point() const { return {{x, y, z}, weight}; }
};

// Exact answers to the two questions an α-complex is made of. Each is the sign of a polynomial in
// coordinate differences and powers relative to the first point, evaluated in doubles; the sign is
// believed when it passes a forward error bound or the arithmetic was exact (Lattice). Otherwise
// CGAL's Compare_weighted_squared_radius_3 and Power_side_of_bounded_power_sphere_3 decide.
//
// With a = q − p and t = |a|² + ωₚ − ω_q, the centre of the smallest orthogonal sphere of a simplex
// at p, q, … is p + c, where 2c·a = t for each further vertex and c lies in the span of the a; its
// squared radius is |c|² − ωₚ. A point s is inside if |s−p|² + ωₚ − ωₛ < 2c·(s−p).
class Predicates {
 public:
  Predicates(double alpha, const Lattice &lattice)
      : alpha_(alpha), exact_(lattice.holds_weights()),
        exact_alpha_(exact_ && lattice.holds(alpha)), lattice_(lattice) {}

  // Whether the squared radius of the smallest orthogonal sphere is at most α.
  bool fits(const Site &p) const;
  bool fits(const Site &p, const Site &q) const;
  bool fits(const Site &p, const Site &q, const Site &r) const;
  bool fits(const Site &p, const Site &q, const Site &r, const Site &s) const;

  // Whether the last point lies strictly inside the smallest orthogonal sphere of the others.
  bool inside(const Site &p, const Site &x) const;
  bool inside(const Site &p, const Site &q, const Site &x) const;
  bool inside(const Site &p, const Site &q, const Site &r, const Site &x) const;

 private:
  struct Ray {
    double x, y, z, power;  // power: |a|² + ωₚ − ω

    Ray(const Site &p, const Site &q)
        : x(q.x - p.x), y(q.y - p.y), z(q.z - p.z),
          power(x * x + y * y + z * z + (p.weight - q.weight)) {}
    double dot(const Ray &o) const { return x * o.x + y * o.y + z * o.z; }
    double length() const {  // largest coordinate
      return std::max({std::abs(x), std::abs(y), std::abs(z)});
    }
  };

  // Largest |coordinate| and largest sum of magnitudes behind a power.
  struct Size {
    double length, power;
  };
  static Size size(const Site &p, const Ray &a, const Site &q) {
    const double length = a.length();
    return {length, 3 * length * length + std::abs(p.weight - q.weight)};
  }
  static Size larger(const Size &a, const Size &b) {
    return {std::max(a.length, b.length), std::max(a.power, b.power)};
  }

  // Every number here is the result of fewer than 32 roundings, so a polynomial whose terms sum to
  // `bound` in magnitude is off by less than 2⁻⁴⁸ of it. That holds while nothing can overflow or
  // lose digits to underflow: within 1e±30 for lengths, of which degrees go up to 8.
  template <int Degree>
  bool decided(double value, double bound, const Size &size, double ball, bool exact) const {
    if (exact && lattice_.exact<Degree>(bound)) return true;
    return size.length > 1e-30 && size.length < 1e30 && size.power < 1e60 &&
           std::abs(ball) < 1e60 && std::abs(value) > 0x1p-48 * bound;
  }

  double alpha_;
  bool exact_;        // weights are on the lattice
  bool exact_alpha_;  // α too
  Lattice lattice_;
  Kernel kernel_;
};

inline bool Predicates::fits(const Site &p) const {
  // −ω ≤ α needs no arithmetic.
  return -p.weight <= alpha_;
}

inline bool Predicates::fits(const Site &p, const Site &q) const {
  const Ray a(p, q);
  const double ball = alpha_ + p.weight;
  const double value = a.power * a.power - 4 * ball * a.dot(a);
  const Size s = size(p, a, q);
  const double bound = s.power * s.power + 12 * std::abs(ball) * s.length * s.length;
  if (decided<4>(value, bound, s, ball, exact_alpha_)) return value <= 0;
  return kernel_.compare_weighted_squared_radius_3_object()(p.point(), q.point(), alpha_) !=
         CGAL::LARGER;
}

inline bool Predicates::fits(const Site &p, const Site &q, const Site &r) const {
  const Ray a(p, q), b(p, r);
  const double aa = a.dot(a), bb = b.dot(b), ab = a.dot(b);
  const double u = bb * a.power - ab * b.power, v = aa * b.power - ab * a.power;
  const double ball = alpha_ + p.weight;
  const double value = u * a.power + v * b.power - 4 * ball * (aa * bb - ab * ab);
  const Size s = larger(size(p, a, q), size(p, b, r));
  const double square = s.length * s.length;
  const double bound = 12 * square * s.power * s.power + 72 * std::abs(ball) * square * square;
  if (decided<6>(value, bound, s, ball, exact_alpha_)) return value <= 0;
  return kernel_.compare_weighted_squared_radius_3_object()(p.point(), q.point(), r.point(),
                                                            alpha_) != CGAL::LARGER;
}

inline bool Predicates::fits(const Site &p, const Site &q, const Site &r, const Site &s) const {
  const Ray a(p, q), b(p, r), c(p, s);
  const double bcx = b.y * c.z - b.z * c.y, bcy = b.z * c.x - b.x * c.z;
  const double bcz = b.x * c.y - b.y * c.x, cax = c.y * a.z - c.z * a.y;
  const double cay = c.z * a.x - c.x * a.z, caz = c.x * a.y - c.y * a.x;
  const double abx = a.y * b.z - a.z * b.y, aby = a.z * b.x - a.x * b.z;
  const double abz = a.x * b.y - a.y * b.x;
  const double det = a.x * bcx + a.y * bcy + a.z * bcz;
  const double x = a.power * bcx + b.power * cax + c.power * abx;
  const double y = a.power * bcy + b.power * cay + c.power * aby;
  const double z = a.power * bcz + b.power * caz + c.power * abz;
  const double ball = alpha_ + p.weight;
  const double value = x * x + y * y + z * z - 4 * ball * det * det;
  const Size largest = larger(size(p, a, q), larger(size(p, b, r), size(p, c, s)));
  const double square = largest.length * largest.length;
  const double bound = square * square *
                       (108 * largest.power * largest.power + 144 * std::abs(ball) * square);
  if (decided<8>(value, bound, largest, ball, exact_alpha_)) return value <= 0;
  return kernel_.compare_weighted_squared_radius_3_object()(
             p.point(), q.point(), r.point(), s.point(), alpha_) != CGAL::LARGER;
}

inline bool Predicates::inside(const Site &p, const Site &x) const {
  const Ray e(p, x);
  // The sphere around p itself has squared radius −ωₚ: inside means |x−p|² + ωₚ − ω < 0.
  const Size s = size(p, e, x);
  if (decided<2>(e.power, s.power, s, 0, exact_)) return e.power < 0;
  return kernel_.power_side_of_bounded_power_sphere_3_object()(p.point(), x.point()) ==
         CGAL::ON_BOUNDED_SIDE;
}

inline bool Predicates::inside(const Site &p, const Site &q, const Site &x) const {
  const Ray a(p, q), e(p, x);
  const double value = e.power * a.dot(a) - a.power * e.dot(a);
  const Size s = larger(size(p, a, q), size(p, e, x));
  const double bound = 6 * s.power * s.length * s.length;
  if (decided<4>(value, bound, s, 0, exact_)) return value < 0;
  return kernel_.power_side_of_bounded_power_sphere_3_object()(p.point(), q.point(), x.point()) ==
         CGAL::ON_BOUNDED_SIDE;
}

inline bool Predicates::inside(const Site &p, const Site &q, const Site &r, const Site &x) const {
  const Ray a(p, q), b(p, r), e(p, x);
  const double aa = a.dot(a), bb = b.dot(b), ab = a.dot(b);
  const double u = bb * a.power - ab * b.power, v = aa * b.power - ab * a.power;
  const double value = e.power * (aa * bb - ab * ab) - (u * e.dot(a) + v * e.dot(b));
  const Size s = larger(larger(size(p, a, q), size(p, b, r)), size(p, e, x));
  const double bound = 54 * s.power * s.length * s.length * s.length * s.length;
  if (decided<6>(value, bound, s, 0, exact_)) return value < 0;
  return kernel_.power_side_of_bounded_power_sphere_3_object()(p.point(), q.point(), r.point(),
                                                               x.point()) == CGAL::ON_BOUNDED_SIDE;
}

}  // namespace walpha
