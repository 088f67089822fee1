#pragma once
// Sums into bins that many iterations share. On the host the iterations are cut into a fixed number of
// chunks with bins of their own, so that the result does not depend on the number of threads; on a device
// bins are shared and the order of rounding is not fixed.
#include <algorithm>
#include <string>
#include <vector>

#include "core/loop.hpp"

namespace peclet {

/// Handed to kernels.
struct Bins {
  Array<Real> sums;
  int count = 0;

  KOKKOS_INLINE_FUNCTION void add(int chunk, int bin, Real value) const {
    if constexpr (runs_on_host)
      sums(static_cast<Index>(chunk) * count + bin) += value;
    else
      Kokkos::atomic_add(&sums(bin), value);
  }
};

class ScatterSum {
 public:
  /// All bins zero.
  void reset(int bins) {
    constexpr Index budget = 1 << 20;  // values in all chunks
    chunks_ = runs_on_host ? static_cast<int>(std::clamp<Index>(budget / std::max(bins, 1), 2, 64)) : 1;
    const auto size = static_cast<std::size_t>(chunks_) * static_cast<std::size_t>(bins);
    if (bins_.sums.extent(0) < size) {
      bins_.sums = Array<Real>("core::bins", size);
      host_ = Kokkos::create_mirror_view(bins_.sums);
    }
    bins_.count = bins;
    Kokkos::deep_copy(bins_.sums, 0.0);
  }
  const Bins& bins() const { return bins_; }
  int chunks() const { return chunks_; }

  /// The sums of all chunks, callable in kernels; the chunks are spent.
  const Array<Real>& join_chunks() {
    const Bins bins = bins_;
    const int chunks = chunks_;
    if (chunks > 1)
      for_each(
          "core::join_chunks", bins.count, KOKKOS_LAMBDA(Index bin) {
            for (int chunk = 1; chunk < chunks; ++chunk)
              bins.sums(bin) += bins.sums(static_cast<Index>(chunk) * bins.count + bin);
          });
    chunks_ = 1;
    return bins_.sums;
  }

  std::vector<Real> totals() {
    Kokkos::deep_copy(host_, join_chunks());
    return {host_.data(), host_.data() + bins_.count};
  }

 private:
  Bins bins_;
  Array<Real>::HostMirror host_;
  int chunks_ = 1;
};

/// body(n, chunk) for 0 <= n < count; the body adds into the bins of its chunk.
template <class Body>
void for_each_scattered(const std::string& label, Index count, const ScatterSum& sum, const Body& body) {
  if constexpr (runs_on_host) {
    const Index chunks = sum.chunks();
    for_each_task(label, chunks, [=](Index chunk) {
      const Index end = (chunk + 1) * count / chunks;
      for (Index n = chunk * count / chunks; n < end; ++n) body(n, static_cast<int>(chunk));
    });
  } else {
    for_each(label, count, KOKKOS_LAMBDA(Index n) { body(n, 0); });
  }
}

}  // namespace peclet
