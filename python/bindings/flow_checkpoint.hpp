#pragma once
#include <nanobind/nanobind.h>

#include "flow/solver.hpp"

namespace peclet::flow {

/// Methods that hand out and take back the whole state of a flow.
void define_checkpoint(nanobind::class_<Solver>& solver);

}  // namespace peclet::flow
