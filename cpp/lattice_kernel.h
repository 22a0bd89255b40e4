// Epick, with the two predicates a triangulation spends its time in decided in doubles more often.
#pragma once

#include <algorithm>
#include <cmath>

#include <CGAL/Triangulation_structural_filtering_traits.h>
#include <CGAL/determinant.h>

#include "walpha/cpp/kernel.h"
#include "walpha/cpp/lattice.h"

namespace walpha {

// The same signs as Kernel, so the same triangulation. Each predicate evaluates its determinant
// once, in doubles, and believes the sign when the value passes a forward error bound, or when the
// arithmetic was exact (Lattice). Otherwise it asks Kernel.
class Lattice_kernel : public Kernel {
 public:
  Lattice_kernel() = default;
  explicit Lattice_kernel(const Lattice &lattice) : lattice_(lattice) {}

  class Orientation_3 : public Kernel::Orientation_3 {
    using Base = Kernel::Orientation_3;

   public:
    using Base::operator();
    explicit Orientation_3(const Lattice &lattice) : lattice_(lattice) {}

    CGAL::Orientation operator()(const Kernel::Point_3 &p, const Kernel::Point_3 &q,
                                 const Kernel::Point_3 &r, const Kernel::Point_3 &s) const {
      const double ax = q.x() - p.x(), ay = q.y() - p.y(), az = q.z() - p.z();
      const double bx = r.x() - p.x(), by = r.y() - p.y(), bz = r.z() - p.z();
      const double cx = s.x() - p.x(), cy = s.y() - p.y(), cz = s.z() - p.z();
      const double det = CGAL::determinant(ax, ay, az, bx, by, bz, cx, cy, cz);
      // Six products of three differences.
      const double bound = 6 * largest(ax, bx, cx) * largest(ay, by, cy) * largest(az, bz, cz);
      if (decided(det, bound) || lattice_.exact<3>(bound)) return CGAL::sign(det);
      return Base::operator()(p, q, r, s);
    }

   private:
    Lattice lattice_;
  };

  class Power_side_of_oriented_power_sphere_3
      : public Kernel::Power_side_of_oriented_power_sphere_3 {
    using Base = Kernel::Power_side_of_oriented_power_sphere_3;
    using Point = Kernel::Weighted_point_3;

   public:
    using Base::operator();
    explicit Power_side_of_oriented_power_sphere_3(const Lattice &lattice) : lattice_(lattice) {}

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
      // 24 products of three differences and a lift.
      const double x = largest(a.x, b.x, c.x, d.x), y = largest(a.y, b.y, c.y, d.y);
      const double z = largest(a.z, b.z, c.z, d.z);
      const double w = largest(a.weight, b.weight, c.weight, d.weight);
      const double bound = 24 * x * y * z * (x * x + y * y + z * z + w);
      const bool exact = (w == 0 || lattice_.holds_weights()) && lattice_.exact<5>(bound);
      if (exact || decided(det, bound)) {
        return static_cast<CGAL::Oriented_side>(-CGAL::sign(det));
      }
      return Base::operator()(p, q, r, s, t);
    }

   private:
    struct Row {
      double x, y, z, weight, lift;
      Row(const Point &p, const Point &t)
          : x(p.x() - t.x()), y(p.y() - t.y()), z(p.z() - t.z()), weight(t.weight() - p.weight()),
            lift(x * x + y * y + z * z + weight) {}
    };

    Lattice lattice_;
  };

  Orientation_3 orientation_3_object() const { return Orientation_3(lattice_); }
  Power_side_of_oriented_power_sphere_3 power_side_of_oriented_power_sphere_3_object() const {
    return Power_side_of_oriented_power_sphere_3(lattice_);
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
  static bool decided(double value, double bound) {
    return bound > 1e-200 && bound < 1e250 && std::abs(value) > 0x1p-48 * bound;
  }

  Lattice lattice_;
};

}  // namespace walpha

// Points are located by walking with plain doubles first, as CGAL does for its own Epick.
template <>
struct CGAL::Triangulation_structural_filtering_traits<walpha::Lattice_kernel> {
  using Use_structural_filtering_tag = CGAL::Tag_true;
};
