#include "walpha/cpp/bridge.h"

#include <cstdlib>
#include <mutex>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <CGAL/assertions.h>
#include <CGAL/assertions_behaviour.h>

namespace walpha {

void throw_quietly() {
  static std::once_flag once;
  std::call_once(once, [] {
    const auto silent = [](const char *, const char *, const char *, int, const char *) {};
    CGAL::set_error_handler(silent);
    CGAL::set_warning_handler(silent);
  });
}

void give_back() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace walpha
