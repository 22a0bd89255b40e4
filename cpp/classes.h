// The numbers of `Class` in crates/complex/src/class.rs.
#pragma once

#include <cstdint>

namespace walpha {

enum Class : std::uint8_t { EXTERIOR = 0, INTERIOR = 1, REGULAR = 2, SINGULAR = 3 };

}  // namespace walpha
