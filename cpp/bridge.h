// How errors cross the bridge: as an exception whose text names the stage, never as an abort.
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include "rust/cxx.h"

namespace rust {
namespace behavior {

// The stock handler catches only std::exception; anything else would terminate the process.
template <typename Try, typename Fail>
static void trycatch(Try &&func, Fail &&fail) noexcept {
  try {
    func();
  } catch (const std::bad_alloc &) {
    fail("out of memory");  // src/cgal/mod.rs knows these words
  } catch (const std::exception &error) {
    fail(error.what());
  } catch (...) {
    fail("an exception of unknown type");
  }
}

}  // namespace behavior
}  // namespace rust

namespace walpha {

// Makes a failed CGAL check throw without writing to the terminal: the caller prints it.
void throw_quietly();

// Allocates what C++ and MPFR keep for each thread: when they first need it, as while an exception is thrown for want of memory,
// there may be none, and the C library would end the process.
void prepare_thread() noexcept;

}  // namespace walpha
