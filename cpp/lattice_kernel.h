// Epick, with the two predicates a triangulation spends its time in decided in doubles more often.
#pragma once

#include <algorithm>
#include <cmath>

#include <CGAL/determinant.h>

#include "walpha/cpp/kernel.h"
#include "walpha/cpp/lattice.h"

namespace walpha {

// The largest differences that a set's coordinates have on each axis, and its weights.
struct Extent {
  double x = 0, y = 0, z = 0, weight = 0;
};

// The same signs as Kernel, so the same triangulation. Each predicate evaluates its determinant
// once, in doubles, and believes the sign when the value passes a forward error bound, or when the
// arithmetic was exact (Lattice): first by a bound that holds for the whole set, then by one for
// the points in hand. Otherwise it asks Kernel.
class Lattice_kernel : public Kernel {
 public:
  Lattice_kernel() = default;
  Lattice_kernel(const Lattice &lattice, const Extent &extent)
      : orientation_(lattice, extent), power_side_(lattice, extent) {}

  class Orientation_3 : public Kernel::Orientation_3 {
    using Base = Kernel::Orientation_3;

   public:
    using Base::operator();
    Orientation_3() = default;
    Orientation_3(const Lattice &lattice, const Extent &e) : lattice_(lattice) {
      const double most = bound(e.x, e.y, e.z);
      enough_ = lattice_.exact<3>(most) ? -1 : error(most);
    }

    CGAL::Orientation operator()(const Kernel::Point_3 &p, const Kernel::Point_3 &q,
                                 const Kernel::Point_3 &r, const Kernel::Point_3 &s) const {
      const double ax = q.x() - p.x(), ay = q.y() - p.y(), az = q.z() - p.z();
      const double bx = r.x() - p.x(), by = r.y() - p.y(), bz = r.z() - p.z();
      const double cx = s.x() - p.x(), cy = s.y() - p.y(), cz = s.z() - p.z();
      const double det = CGAL::determinant(ax, ay, az, bx, by, bz, cx, cy, cz);
      if (std::abs(det) > enough_) return CGAL::sign(det);
      const double most = bound(largest(ax, bx, cx), largest(ay, by, cy), largest(az, bz, cz));
      if (std::abs(det) > error(most) || lattice_.exact<3>(most)) return CGAL::sign(det);
      return Base::operator()(p, q, r, s);
    }

   private:
    // Six products of three differences.
    static double bound(double x, double y, double z) { return 6 * x * y * z; }

    Lattice lattice_;
    double enough_ = HUGE_VAL;
  };

  class Power_side_of_oriented_power_sphere_3
      : public Kernel::Power_side_of_oriented_power_sphere_3 {
    using Base = Kernel::Power_side_of_oriented_power_sphere_3;
    using Point = Kernel::Weighted_point_3;

   public:
    using Base::operator();
    Power_side_of_oriented_power_sphere_3() = default;
    Power_side_of_oriented_power_sphere_3(const Lattice &lattice, const Extent &e)
        : lattice_(lattice) {
      const double most = bound(e.x, e.y, e.z, e.weight);
      enough_ = exact(most, e.weight) ? -1 : error(most);
    }

    CGAL::Oriented_side operator()(const Point &p, const Point &q, const Point &r, const Point &s,
                                   const Point &t) const {
      const Row a(p, t), b(q, t), c(r, t), d(s, t);
      // det of the rows (x, y, z, lift), by 2×2 minors.
      const double xy_ab = a.x * b.y - b.x * a.y, xy_ac = a.x * c.y - c.x * a.y;
      const double xy_ad = a.x * d.y - d.x * a.y, xy_bc = b.x * c.y - c.x * b.y;
      const double xy_bd = b.x * d.y - d.x * b.y, xy_cd = c.x * d.y - d.x * c.y;
      const double zl_ab = a.z * b.lift - b.z * a.lift, zl_ac = a.z * c.lift - c.z * a.lift;
      const double zl_ad = a.z * d.lift - d.z * a.lift, zl_bc = b.z * c.lift - c.z * b.lift;
      const double zl_bd = b.z * d.lift - d.z * b.lift, zl_cd = c.z * d.lift - d.z * c.lift;
      const double det = xy_ab * zl_cd - xy_ac * zl_bd + xy_ad * zl_bc + xy_bc * zl_ad -
                         xy_bd * zl_ac + xy_cd * zl_ab;
      if (std::abs(det) > enough_) return side(det);
      const double x = largest(a.x, b.x, c.x, d.x), y = largest(a.y, b.y, c.y, d.y);
      const double z = largest(a.z, b.z, c.z, d.z);
      const double w = largest(a.weight, b.weight, c.weight, d.weight);
      const double most = bound(x, y, z, w);
      if (std::abs(det) > error(most) || exact(most, w)) return side(det);
      return Base::operator()(p, q, r, s, t);
    }

   private:
    struct Row {
      double x, y, z, weight, lift;
      Row(const Point &p, const Point &t)
          : x(p.x() - t.x()), y(p.y() - t.y()), z(p.z() - t.z()), weight(t.weight() - p.weight()),
            lift(x * x + y * y + z * z + weight) {}
    };

    static CGAL::Oriented_side side(double det) {
      return static_cast<CGAL::Oriented_side>(-CGAL::sign(det));
    }
    // 24 products of three differences and a lift.
    static double bound(double x, double y, double z, double weight) {
      return 24 * x * y * z * (x * x + y * y + z * z + weight);
    }
    bool exact(double bound, double weight) const {
      return (weight == 0 || lattice_.holds_weights()) && lattice_.exact<5>(bound);
    }

    Lattice lattice_;
    double enough_ = HUGE_VAL;
  };

  const Orientation_3 &orientation_3_object() const { return orientation_; }
  const Power_side_of_oriented_power_sphere_3 &power_side_of_oriented_power_sphere_3_object()
      const {
    return power_side_;
  }

 private:
  template <typename... More>
  static double largest(double first, More... more) {
    double result = std::abs(first);
    ((result = std::max(result, std::abs(more))), ...);
    return result;
  }

  // A sum of products of rounded differences of total magnitude `bound`, each number having gone
  // through fewer than 32 roundings of relative size 2⁻⁵³, is off by less than 2⁻⁴⁸ of it. Bounds
  // near the ends of the exponent range prove nothing, as intermediate results may under- or
  // overflow there.
  static double error(double bound) {
    return bound > 1e-200 && bound < 1e250 ? 0x1p-48 * bound : HUGE_VAL;
  }

  Orientation_3 orientation_;
  Power_side_of_oriented_power_sphere_3 power_side_;
};

}  // namespace walpha
