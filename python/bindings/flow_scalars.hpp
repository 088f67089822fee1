#pragma once
#include <nanobind/nanobind.h>

#include "flow/solver.hpp"

namespace peclet::flow {

/// The calls about scalars on the compiled solver.
void define_scalars(nanobind::module_& m, nanobind::class_<Solver>& solver);

}  // namespace peclet::flow
