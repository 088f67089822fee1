#pragma once
// Arrays in large pages. A sweep reads many fields at once; in pages of 4 kB it waits for the translation of
// addresses and for the prefetcher, which stops at the end of a page.
#include <cstdint>
#include <string>

#include "core/types.hpp"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace peclet {

/// Asks for large pages wherever they fit in; for memory that has not been touched yet.
inline void advise_large_pages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(data);
  const std::uintptr_t begin = (address + page - 1) / page * page, end = (address + bytes) / page * page;
  // advice only: without it everything works as well
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

/// Zeros.
template <class T>
Array<T> array_in_large_pages(const std::string& name, Index size) {
  if constexpr (runs_on_host) {
    const Array<T> array(Kokkos::view_alloc(name, Kokkos::WithoutInitializing), size);
    advise_large_pages(array.data(), static_cast<std::size_t>(size) * sizeof(T));
    Kokkos::deep_copy(array, T());
    return array;
  } else {
    return Array<T>(name, size);
  }
}

}  // namespace peclet
