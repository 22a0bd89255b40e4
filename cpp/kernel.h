// What every part of the bridge computes with.
#pragma once

#include <exception>
#include <new>

#include <CGAL/tss.h>

namespace walpha {

// Renews what CGAL keeps for a thread if an exception leaves it half changed; the next triangulation on this thread would use it.
template <class T>
class Renewed {
 public:
  explicit Renewed(T &kept) : kept_(kept) {}
  Renewed(const Renewed &) = delete;
  Renewed &operator=(const Renewed &) = delete;

  ~Renewed() {
    if (std::uncaught_exceptions() > before_) {
      // GCC 12 leaves out some of the constructor where it is inlined here.
      void (*volatile renew)(T &) = [](T &kept) {
        kept.~T();
        new (&kept) T();
      };
      renew(kept_);
    }
  }

 private:
  T &kept_;
  const int before_ = std::uncaught_exceptions();
};

}  // namespace walpha

// Triangulation_data_structure_3::_insert_in_small_hole keeps a map so, which it leaves as it is when there is no memory for a
// cell. This header comes before those of CGAL that use the macro.
#ifdef CGAL_STATIC_THREAD_LOCAL_VARIABLE_0
#undef CGAL_STATIC_THREAD_LOCAL_VARIABLE_0
#define CGAL_STATIC_THREAD_LOCAL_VARIABLE_0(TYPE, VAR) \
  static thread_local TYPE VAR;                        \
  const walpha::Renewed<TYPE> renewed_##VAR(VAR)
#endif

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace walpha {

// Exact predicates decide every combinatorial question; the bridge reads no constructed number.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

}  // namespace walpha
