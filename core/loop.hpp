#pragma once
// The only place that names execution policies. Bodies are KOKKOS_LAMBDAs with explicit types.
//
// On the host one thread owns whole rows and the x loop is innermost, so that the compiler vectorises it;
// iterations of one row must therefore be independent of each other. Reductions run over a fixed
// partition of rows and are bitwise repeatable for a given number of threads.
#include <string>

#include "core/grid.hpp"
#include "core/types.hpp"

#if defined(__GNUC__) && !defined(__CUDA_ARCH__)
#define PECLET_INDEPENDENT_ITERATIONS _Pragma("GCC ivdep")
#else
#define PECLET_INDEPENDENT_ITERATIONS
#endif

namespace peclet {

/// Half-open range of cells.
struct Box {
  Int3 low{0, 0, 0}, high{0, 0, 0};

  KOKKOS_INLINE_FUNCTION int extent(int axis) const { return high[axis] - low[axis]; }
  KOKKOS_INLINE_FUNCTION Index size() const { return static_cast<Index>(extent(0)) * extent(1) * extent(2); }
  KOKKOS_INLINE_FUNCTION bool contains(int i, int j, int k) const {
    return i >= low[0] && i < high[0] && j >= low[1] && j < high[1] && k >= low[2] && k < high[2];
  }
};

/// Box whose rows along x may start late and end early, because the rest is solid for good.
struct RowRanges {
  Box box;
  Array<int> first, last;  // per row (j - low) + (k - low) * extent(1): cells first <= i < last

  RowRanges() = default;
  explicit RowRanges(const Box& whole) : box(whole) {}
  explicit RowRanges(const Int3& cells) : box{{0, 0, 0}, cells} {}

  KOKKOS_INLINE_FUNCTION int begin(Index row) const { return first.data() ? first.data()[row] : box.low[0]; }
  KOKKOS_INLINE_FUNCTION int end(Index row) const { return first.data() ? last.data()[row] : box.high[0]; }
  KOKKOS_INLINE_FUNCTION Index number_of_rows() const {
    return static_cast<Index>(box.extent(1)) * box.extent(2);
  }
};

/// Lists and boxes with fewer entries and cells than this are not worth several threads on the host.
inline constexpr Index smallest_parallel_list = 512, smallest_parallel_box = 4096;
inline bool is_serial_list(Index count) { return runs_on_host && count < smallest_parallel_list; }
inline bool is_serial_box(Index cells) { return runs_on_host && cells < smallest_parallel_box; }

/// body(n) for 0 <= n < count, each of them worth a thread.
template <class Body>
void for_each_task(const std::string& label, Index count, const Body& body) {
  if (count <= 0) return;
  if constexpr (runs_on_host) {
    if (count == 1) return body(0);
  }
  Kokkos::parallel_for(
      label,
      Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>, Kokkos::Schedule<Kokkos::Static>>(0,
                                                                                                      count),
      body);
}

/// body(n) for 0 <= n < count.
template <class Body>
void for_each(const std::string& label, Index count, const Body& body) {
  if (!is_serial_list(count)) return for_each_task(label, count, body);
  if constexpr (runs_on_host)
    for (Index n = 0; n < count; ++n) body(n);
}

/// body(i, j, k) on every cell of the ranges.
template <class Body>
void for_each_cell(const std::string& label, const RowRanges& ranges, const Body& body) {
  const Box box = ranges.box;
  if (box.size() <= 0) return;
  const Index ny = box.extent(1);
  if constexpr (runs_on_host) {
    const auto treat_row = [=](Index row) {
      const int j = box.low[1] + static_cast<int>(row % ny);
      const int k = box.low[2] + static_cast<int>(row / ny);
      const int end = ranges.end(row);
      PECLET_INDEPENDENT_ITERATIONS
      for (int i = ranges.begin(row); i < end; ++i) body(i, j, k);
    };
    if (!is_serial_box(box.size())) return for_each_task(label, ranges.number_of_rows(), treat_row);
    for (Index row = 0; row < ranges.number_of_rows(); ++row) treat_row(row);
  } else {
    const Index nx = box.extent(0);
    for_each(
        label, box.size(), KOKKOS_LAMBDA(Index n) {
          const Index row = n / nx;
          const int i = box.low[0] + static_cast<int>(n % nx);
          if (i >= ranges.begin(row) && i < ranges.end(row))
            body(i, box.low[1] + static_cast<int>(row % ny), box.low[2] + static_cast<int>(row / ny));
        });
  }
}

template <class Body>
void for_each_cell(const std::string& label, const Box& box, const Body& body) {
  for_each_cell(label, RowRanges(box), body);
}

/// Sum of body(i, j, k) over the ranges.
template <class Body>
Real sum_cells(const std::string& label, const RowRanges& ranges, const Body& body) {
  const Box box = ranges.box;
  if (box.size() <= 0) return 0;
  const Index ny = box.extent(1);
  Real total = 0;
  if constexpr (runs_on_host) {
    const auto add_row = [=](Index row, Real& sum) {
      const int j = box.low[1] + static_cast<int>(row % ny);
      const int k = box.low[2] + static_cast<int>(row / ny);
      const int end = ranges.end(row);
      Real row_sum = 0;
#pragma omp simd reduction(+ : row_sum)
      for (int i = ranges.begin(row); i < end; ++i) row_sum += body(i, j, k);
      sum += row_sum;
    };
    if (is_serial_box(box.size()))
      for (Index row = 0; row < ranges.number_of_rows(); ++row) add_row(row, total);
    else
      Kokkos::parallel_reduce(
          label,
          Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>, Kokkos::Schedule<Kokkos::Static>>(
              0, ranges.number_of_rows()),
          add_row, total);
  } else {
    const Index nx = box.extent(0);
    Kokkos::parallel_reduce(
        label, Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>>(0, box.size()),
        KOKKOS_LAMBDA(Index n, Real & sum) {
          const Index row = n / nx;
          const int i = box.low[0] + static_cast<int>(n % nx);
          if (i >= ranges.begin(row) && i < ranges.end(row))
            sum += body(i, box.low[1] + static_cast<int>(row % ny), box.low[2] + static_cast<int>(row / ny));
        },
        total);
  }
  return total;
}

/// Largest of body(i, j, k) over the ranges, at least zero.
template <class Body>
Real max_cells(const std::string& label, const RowRanges& ranges, const Body& body) {
  const Box box = ranges.box;
  if (box.size() <= 0) return 0;
  const Index ny = box.extent(1);
  Real largest = 0;
  if constexpr (runs_on_host) {
    const auto raise_by_row = [=](Index row, Real& maximum) {
      const int j = box.low[1] + static_cast<int>(row % ny);
      const int k = box.low[2] + static_cast<int>(row / ny);
      const int end = ranges.end(row);
      Real row_maximum = 0;
#pragma omp simd reduction(max : row_maximum)
      for (int i = ranges.begin(row); i < end; ++i) {
        const Real value = body(i, j, k);
        row_maximum = value > row_maximum ? value : row_maximum;
      }
      maximum = row_maximum > maximum ? row_maximum : maximum;
    };
    if (is_serial_box(box.size()))
      for (Index row = 0; row < ranges.number_of_rows(); ++row) raise_by_row(row, largest);
    else
      Kokkos::parallel_reduce(
          label,
          Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>, Kokkos::Schedule<Kokkos::Static>>(
              0, ranges.number_of_rows()),
          raise_by_row, Kokkos::Max<Real>(largest));
  } else {
    const Index nx = box.extent(0);
    Kokkos::parallel_reduce(
        label, Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>>(0, box.size()),
        KOKKOS_LAMBDA(Index n, Real & maximum) {
          const Index row = n / nx;
          const int i = box.low[0] + static_cast<int>(n % nx);
          if (i < ranges.begin(row) || i >= ranges.end(row)) return;
          const Real value =
              body(i, box.low[1] + static_cast<int>(row % ny), box.low[2] + static_cast<int>(row / ny));
          maximum = value > maximum ? value : maximum;
        },
        Kokkos::Max<Real>(largest));
  }
  return largest < 0 ? 0 : largest;
}

/// body(i, j) for 0 <= i < columns, 0 <= j < rows of a small table: not worth several threads on the host.
template <class Body>
void for_each_entry(const std::string& label, int columns, int rows, const Body& body) {
  if constexpr (runs_on_host) {
    const Body entry = body;
    for (int j = 0; j < rows; ++j) {
      PECLET_INDEPENDENT_ITERATIONS
      for (int i = 0; i < columns; ++i) entry(i, j);
    }
  } else {
    for_each(
        label, static_cast<Index>(columns) * rows,
        KOKKOS_LAMBDA(Index n) { body(static_cast<int>(n % columns), static_cast<int>(n / columns)); });
  }
}

/// body(n) for 0 <= n < count: in order on the host, where sums must not depend on the number of threads, and
/// in any order on a device, where atomic sums are rounded as they come.
template <class Body>
void for_each_ordered_on_host(const std::string& label, Index count, const Body& body) {
  if constexpr (runs_on_host) {
    for (Index n = 0; n < count; ++n) body(n);
  } else {
    for_each(label, count, body);
  }
}

/// body(i, j, k, sum, squares, largest) adds to two sums and raises a maximum, in one pass.
template <class Body>
void reduce_cells(const std::string& label, const RowRanges& ranges, const Body& body, Real& sum,
                  Real& squares, Real& largest) {
  const Box box = ranges.box;
  const Index nx = box.extent(0), ny = box.extent(1);
  if (box.size() <= 0) return;
  Kokkos::parallel_reduce(
      label, Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>>(0, box.size()),
      KOKKOS_LAMBDA(Index n, Real & s, Real & q, Real & m) {
        const Index row = n / nx;
        const int i = box.low[0] + static_cast<int>(n % nx);
        if (i >= ranges.begin(row) && i < ranges.end(row))
          body(i, box.low[1] + static_cast<int>(row % ny), box.low[2] + static_cast<int>(row / ny), s, q, m);
      },
      sum, squares, Kokkos::Max<Real>(largest));
}

/// Sum of body(n) over 0 <= n < count.
template <class Body>
Real sum_each(const std::string& label, Index count, const Body& body) {
  Real total = 0;
  if (is_serial_list(count))
    for (Index n = 0; n < count; ++n) total += body(n);
  else
    Kokkos::parallel_reduce(
        label,
        Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>, Kokkos::Schedule<Kokkos::Static>>(
            0, count),
        KOKKOS_LAMBDA(Index n, Real & sum) { sum += body(n); }, total);
  return total;
}

/// Lists what select(place, entry) puts into entry where it returns true, in order, for the places at(n),
/// n < count; returns the number of entries. list has room for count entries. On the host places.advance
/// goes from one place to the next; on a device select runs twice.
template <class T, class Places, class Select>
Index list_selected(const std::string& label, Index count, const Places& places, const Array<T>& list,
                    const Select& select) {
  Index total = 0;
  if constexpr (runs_on_host) {
    constexpr Index most_chunks = 64;
    const Index threads = static_cast<Index>(ExecutionSpace().concurrency());
    const Index chunks = is_serial_list(count) ? 1 : (threads < most_chunks ? threads : most_chunks);
    Index sizes[most_chunks];
    Index* const size = sizes;
    for_each_task(label, chunks, [=](Index chunk) {
      const Index begin = chunk * count / chunks, end = (chunk + 1) * count / chunks;
      size[chunk] = 0;
      if (begin == end) return;
      Index next = begin;
      auto place = places.at(begin);
      for (Index n = begin; n < end; ++n, places.advance(place)) next += select(place, list(next)) ? 1 : 0;
      size[chunk] = next - begin;
    });
    for (Index chunk = 0; chunk < chunks; ++chunk) {
      const Index from = chunk * count / chunks;
      if (from != total)
        for (Index n = 0; n < sizes[chunk]; ++n) list(total + n) = list(from + n);
      total += sizes[chunk];
    }
  } else {
    Kokkos::parallel_scan(
        label, Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>>(0, count),
        KOKKOS_LAMBDA(Index n, Index & running, bool is_final) {
          T entry;
          if (!select(places.at(n), entry)) return;
          if (is_final) list(running) = entry;
          ++running;
        },
        total);
  }
  return total;
}

/// Places that are the numbers from 0.
struct Numbers {
  KOKKOS_INLINE_FUNCTION Index at(Index n) const { return n; }
  KOKKOS_INLINE_FUNCTION void advance(Index& n) const { ++n; }
};

/// Lists the n < count with keep(n), in order; returns their number. list has room for count entries.
template <class Keep>
Index list_where(const std::string& label, Index count, const Array<Index>& list, const Keep& keep) {
  return list_selected(
      label, count, Numbers(), list, KOKKOS_LAMBDA(Index n, Index & entry) {
        entry = n;
        return keep(n);
      });
}

/// Largest of body(n) over 0 <= n < count, at least zero; the same for any number of threads.
template <class Body>
Real max_each(const std::string& label, Index count, const Body& body) {
  Real largest = 0;
  if (is_serial_list(count))
    for (Index n = 0; n < count; ++n) largest = Kokkos::fmax(largest, body(n));
  else
    Kokkos::parallel_reduce(
        label, Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>>(0, count),
        KOKKOS_LAMBDA(Index n, Real & maximum) {
          const Real value = body(n);
          if (value > maximum) maximum = value;
        },
        Kokkos::Max<Real>(largest));
  return largest > 0 ? largest : 0;
}

/// offsets[n] = sum of amount(m) over m < n, for 0 <= n <= count; returns the whole sum.
template <class Amount>
Index exclusive_sum(const std::string& label, Index count, const Array<Index>& offsets,
                    const Amount& amount) {
  Index total = 0;
  if (is_serial_list(count)) {
    for (Index n = 0; n < count; ++n) {
      offsets(n) = total;
      total += amount(n);
    }
    offsets(count) = total;
    return total;
  }
  Kokkos::parallel_scan(
      label, Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>>(0, count + 1),
      KOKKOS_LAMBDA(Index n, Index & running, bool is_final) {
        if (is_final) offsets(n) = running;
        if (n < count) running += amount(n);
      },
      total);
  return total;
}

/// body(n) for first <= n < last.
template <class Body>
void for_each_from(const std::string& label, Index first, Index last, const Body& body) {
  if (first >= last) return;
  if (is_serial_list(last - first)) {
    for (Index n = first; n < last; ++n) body(n);
    return;
  }
  Kokkos::parallel_for(
      label,
      Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>, Kokkos::Schedule<Kokkos::Static>>(first,
                                                                                                      last),
      body);
}

template <class Body>
struct InOrder {
  Body body;
  Index first, last;
  KOKKOS_FUNCTION void operator()(Index) const {
    for (Index n = first; n < last; ++n) body(n);
  }
};

/// body(n) for first <= n < last, one after the other.
template <class Body>
void for_each_in_order(const std::string& label, Index first, Index last, const Body& body) {
  if (first < last) for_each(label, 1, InOrder<Body>{body, first, last});
}

}  // namespace peclet
