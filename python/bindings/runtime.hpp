#pragma once
// The Kokkos runtime: one for all modules of the process.

namespace peclet::python {

/// Start Kokkos unless another module has done so; every module calls this first. It runs until the process
/// ends, because Python may release arrays later than any hook for an orderly stop.
void start_runtime();

}  // namespace peclet::python
