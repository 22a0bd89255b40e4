#include "walpha/cpp/bridge.h"

#include <mutex>

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

}  // namespace walpha
