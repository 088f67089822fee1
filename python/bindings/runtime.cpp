#include "python/bindings/runtime.hpp"

#include <Kokkos_Core.hpp>
#include <stdexcept>

namespace peclet::python {

void start_runtime() {
  if (Kokkos::is_initialized()) return;
  if (Kokkos::is_finalized())
    throw std::runtime_error("Kokkos was stopped in this process and cannot start again");
  // The only warning at start concerns OMP_PROC_BIND. Threads stay unbound unless the user asks for more:
  // bound ones would confine every other library of the process, too.
  Kokkos::initialize(Kokkos::InitializationSettings().set_disable_warnings(true));
}

}  // namespace peclet::python
