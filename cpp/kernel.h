// What every part of the bridge computes with.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace walpha {

// Exact predicates decide every combinatorial question; the bridge reads no constructed number.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

}  // namespace walpha
