#include "walpha/cpp/bridge.h"

#include <exception>
#include <mutex>

#include <CGAL/assertions.h>
#include <CGAL/assertions_behaviour.h>
#include <CGAL/config.h>
#ifdef CGAL_USE_MPFR
#include <mpfr.h>
#endif

namespace walpha {

void throw_quietly() {
  static std::once_flag once;
  std::call_once(once, [] {
    const auto silent = [](const char *, const char *, const char *, int, const char *) {};
    CGAL::set_error_handler(silent);
    CGAL::set_warning_handler(silent);
  });
}

void prepare_thread() noexcept {
  // One variable of each library is enough. Compilers may leave out a call whose result is not used.
  [[maybe_unused]] volatile auto thrown = std::uncaught_exceptions();
#ifdef CGAL_USE_MPFR
  [[maybe_unused]] volatile auto least = mpfr_get_emin();
#endif
}

}  // namespace walpha
