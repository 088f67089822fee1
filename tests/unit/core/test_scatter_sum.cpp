#include "core/scatter_sum.hpp"

#include <gtest/gtest.h>

namespace {

using namespace peclet;

/// Iteration n adds 1/2^n-like values to bin n % bins, and 1 to the last one.
std::vector<Real> sums_of(ScatterSum& scatter, int bins, Index count) {
  scatter.reset(bins);
  const Bins target = scatter.bins();
  for_each_scattered(
      "fill_bins", count, scatter, KOKKOS_LAMBDA(Index n, int chunk) {
        target.add(chunk, static_cast<int>(n % bins), static_cast<Real>(n));
        target.add(chunk, bins - 1, 1.0);
      });
  return scatter.totals();
}

TEST(ScatterSum, CountsEveryIterationOnce) {
  ScatterSum scatter;
  for (const Index count : {Index{0}, Index{1}, Index{63}, Index{1000}}) {
    const std::vector<Real> sums = sums_of(scatter, 4, count);
    Real total = 0;
    for (const Real sum : sums) total += sum;
    // integers: no rounding
    EXPECT_EQ(total, static_cast<Real>(count * (count - 1) / 2 + count));
  }
}

TEST(ScatterSum, BinsAreSeparate) {
  ScatterSum scatter;
  const std::vector<Real> sums = sums_of(scatter, 3, 9);
  EXPECT_EQ(sums[0], 0 + 3 + 6);
  EXPECT_EQ(sums[1], 1 + 4 + 7);
  EXPECT_EQ(sums[2], 2 + 5 + 8 + 9);
}

TEST(ScatterSum, StartsFromZeroWithFewerOrMoreBins) {
  ScatterSum scatter;
  sums_of(scatter, 50, 200);
  for (const int bins : {7, 80}) {
    scatter.reset(bins);
    for (const Real sum : scatter.totals()) EXPECT_EQ(sum, 0);
  }
}

TEST(ScatterSum, HandlesManyBins) {
  ScatterSum scatter;
  const int bins = 1 << 20;
  const std::vector<Real> sums = sums_of(scatter, bins, 10);
  EXPECT_EQ(sums[9], 9);
  EXPECT_EQ(sums[static_cast<std::size_t>(bins - 1)], 10);
}

}  // namespace
