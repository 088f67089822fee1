#pragma once
// The only place that names Kokkos execution and memory spaces.
#include <Kokkos_Core.hpp>
#include <cstddef>
#include <cstdint>

/// Of a large function for kernels: nvcc copies all others into each of their calls, in hours for this one.
#ifdef __CUDACC__
#define PECLET_CALLED_FUNCTION __noinline__ KOKKOS_FUNCTION
#else
#define PECLET_CALLED_FUNCTION inline
#endif

namespace peclet {

using Real = double;
using Index = std::ptrdiff_t;

using ExecutionSpace = Kokkos::DefaultExecutionSpace;
using MemorySpace = ExecutionSpace::memory_space;

template <class T>
using Array = Kokkos::View<T*, MemorySpace>;

using Int3 = Kokkos::Array<int, 3>;
using Real3 = Kokkos::Array<Real, 3>;

/// Whether the host can read and write what kernels do.
inline constexpr bool is_host_memory = Kokkos::SpaceAccessibility<Kokkos::HostSpace, MemorySpace>::accessible;

/// True where kernels run on the host, so that rows can be walked by one thread. With PECLET_DEVICE_LOOPS
/// never: loops then have the form that a GPU gives them.
#ifdef PECLET_DEVICE_LOOPS
inline constexpr bool runs_on_host = false;
#else
inline constexpr bool runs_on_host = is_host_memory;
#endif

}  // namespace peclet
