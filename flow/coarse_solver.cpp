#include "flow/coarse_solver.hpp"

namespace peclet::flow {
namespace {

struct DenseMatrix {
  int size;
  Real* values;
  KOKKOS_INLINE_FUNCTION Real& operator()(Index i, Index j) const { return values[i * size + j]; }
};

/// Which cells are connected, as one row of bits per cell, and which touch a Fixed side.
struct Connections {
  using Word = CoarseSolver::Word;
  static constexpr int bits = 64;

  int size;
  Word* connected;
  unsigned char* fixed;
  KOKKOS_INLINE_FUNCTION int words() const { return (size + bits - 1) / bits; }
  KOKKOS_INLINE_FUNCTION Word* row(int i) const { return connected + static_cast<Index>(i) * words(); }
  KOKKOS_INLINE_FUNCTION bool operator()(int i, int j) const { return row(i)[j / bits] >> (j % bits) & 1; }
  KOKKOS_INLINE_FUNCTION void connect(int i, int j) const { row(i)[j / bits] |= Word(1) << (j % bits); }
};

/// Row n of the operator and of the adjacency.
template <class Coefficient>
KOKKOS_INLINE_FUNCTION void write_row(const LevelOperator<Coefficient>& op, const float* reaction, int n,
                                      const DenseMatrix& matrix, const Connections& connections) {
  const LevelShape& shape = op.shape;
  const int nx = shape.cells[0], ny = shape.cells[1];
  const Int3 cell{n % nx, n / nx % ny, n / (nx * ny)};
  for (int m = 0; m < matrix.size; ++m) matrix(n, m) = 0;
  for (int word = 0; word < connections.words(); ++word) connections.row(n)[word] = 0;
  connections.connect(n, n);
  const Real extra = reaction ? reaction[shape.layout(cell[0], cell[1], cell[2])] : 0;
  matrix(n, n) = extra;
  connections.fixed[n] = extra > 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high) {
      Int3 face = cell, other = cell;
      face[axis] += high;
      other[axis] += high ? 1 : -1;
      const Real c = op.face(axis, face[0], face[1], face[2]);
      const bool beyond = other[axis] < 0 || other[axis] >= shape.cells[axis];
      const PressureSide side = beyond ? shape.sides.side[axis][high] : PressureSide::Periodic;
      if (!(c > 0) || side == PressureSide::Closed) continue;
      if (side == PressureSide::Fixed) {
        matrix(n, n) += 2 * c;
        connections.fixed[n] = 1;
        continue;
      }
      if (beyond) other[axis] = high ? 0 : shape.cells[axis] - 1;
      const int m = other[0] + nx * (other[1] + ny * other[2]);
      matrix(n, n) += c;
      matrix(n, m) -= c;
      connections.connect(n, m);
    }
}

/// Connected becomes transitive [Warshall1962].
void close_connections(const Connections& connections) {
  for (int via = 0; via < connections.size; ++via)
    for_each_entry(
        "flow::connect", connections.size, 1, KOKKOS_LAMBDA(int i, int) {
          if (i == via || !connections(i, via)) return;
          for (int word = 0; word < connections.words(); ++word)
            connections.row(i)[word] |= connections.row(via)[word];
        });
}

/// A -> A + sum over singular regions of scale v v^T, v being the constant unit vector of the region and
/// scale its mean diagonal; then removed[i] = 1 / (scale * size) is what the inverse has too much.
void regularise(const DenseMatrix& matrix, const Connections& connections, Real* added, Real* removed) {
  const int size = matrix.size;
  for_each_entry(
      "flow::region_scale", size, 1, KOKKOS_LAMBDA(int i, int) {
        Real sum = 0;
        int cells = 0;
        bool singular = matrix(i, i) > 0;
        for (int m = 0; m < size; ++m)
          if (connections(i, m)) {
            sum += matrix(m, m);
            ++cells;
            if (connections.fixed[m]) singular = false;
          }
        const Real scale = sum / cells;
        added[i] = singular ? scale / cells : 0;
        removed[i] = singular ? 1 / (scale * cells) : 0;
      });
  for_each_entry(
      "flow::regularise", size, size, KOKKOS_LAMBDA(int j, int i) {
        if (i == j && !(matrix(i, j) > 0)) matrix(i, j) = 1;
        if (connections(i, j)) matrix(i, j) += added[i];
      });
}

/// One step of Gauss-Jordan inversion, out of place; positive definite matrices need no pivoting.
void eliminate(const DenseMatrix& from, const DenseMatrix& to, int pivot) {
  for_each_entry(
      "flow::eliminate", from.size, from.size, KOKKOS_LAMBDA(int j, int i) {
        const Real inverse_pivot = 1 / from(pivot, pivot);
        const Real factor = i == pivot ? -inverse_pivot : from(i, pivot) * inverse_pivot;
        const Real old = i == pivot || j == pivot ? 0 : from(i, j);
        const Real pivot_entry = j == pivot ? 1 : from(pivot, j);
        to(i, j) = old - factor * pivot_entry;
      });
}

/// The inverse of the regularised matrix without the constants; zero in empty cells.
void extract(const DenseMatrix& inverse, const Connections& connections, const unsigned char* is_empty,
             const Real* removed, float* pseudo_inverse) {
  const int size = inverse.size;
  for_each_entry(
      "flow::extract", size, size, KOKKOS_LAMBDA(int j, int i) {
        const Real value = inverse(i, j) - (connections(i, j) ? removed[i] : 0);
        pseudo_inverse[static_cast<Index>(i) * size + j] =
            is_empty[i] || is_empty[j] ? 0 : static_cast<float>(value);
      });
}

template <class Coefficient>
void assemble(const LevelOperator<Coefficient>& op, const float* reaction, const DenseMatrix& matrix,
              const Connections& connections, unsigned char* is_empty) {
  for_each_entry(
      "flow::assemble", matrix.size, 1, KOKKOS_LAMBDA(int n, int) {
        write_row(op, reaction, n, matrix, connections);
        is_empty[n] = !(matrix(n, n) > 0);
      });
}

/// solution = pseudo-inverse * rhs; the matrix is symmetric, so that either index may run fastest.
void multiply(const LevelShape& shape, const float* matrix, float* vector, const Field<float>& rhs,
              const Field<float>& solution) {
  const int size = static_cast<int>(shape.number_of_cells()), nx = shape.cells[0], ny = shape.cells[1];
  for_each_entry(
      "flow::gather", size, 1,
      KOKKOS_LAMBDA(int n, int) { vector[n] = rhs(n % nx, n / nx % ny, n / (nx * ny)); });
  for_each_entry(
      "flow::multiply", 1, size, KOKKOS_LAMBDA(int, int n) {
        const Index start = runs_on_host ? static_cast<Index>(n) * size : n, step = runs_on_host ? 1 : size;
        float sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int m = 0; m < size; ++m) sum += matrix[start + m * step] * vector[m];
        solution(n % nx, n / nx % ny, n / (nx * ny)) = sum;
      });
}

}  // namespace

CoarseSolver::CoarseSolver(const LevelShape& shape) : shape_(shape) {
  const Index n = shape.number_of_cells();
  matrix_ = Array<Real>("coarse_matrix", n * n);
  inverse_ = Array<Real>("coarse_inverse", n * n);
  connected_ = Array<Word>("coarse_connected", n * ((n + Connections::bits - 1) / Connections::bits));
  fixed_ = Array<unsigned char>("coarse_fixed", n);
  empty_ = Array<unsigned char>("coarse_empty", n);
  added_ = Array<Real>("coarse_added", n);
  removed_ = Array<Real>("coarse_removed", n);
  pseudo_inverse_ = Array<float>("coarse_pseudo_inverse", n * n);
  vector_ = Array<float>("coarse_vector", n);
}

template <class Coefficient>
void CoarseSolver::set_operator(const LevelOperator<Coefficient>& op, const float* reaction) const {
  const int size = static_cast<int>(shape_.number_of_cells());
  const DenseMatrix matrix{size, matrix_.data()}, other{size, inverse_.data()};
  const Connections connections{size, connected_.data(), fixed_.data()};
  assemble(op, reaction, matrix, connections, empty_.data());
  close_connections(connections);
  regularise(matrix, connections, added_.data(), removed_.data());
  for (int pivot = 0; pivot < size; ++pivot)
    eliminate(pivot % 2 == 0 ? matrix : other, pivot % 2 == 0 ? other : matrix, pivot);
  extract(size % 2 == 0 ? matrix : other, connections, empty_.data(), removed_.data(),
          pseudo_inverse_.data());
}

template void CoarseSolver::set_operator(const LevelOperator<OpenFraction>&, const float*) const;
template void CoarseSolver::set_operator(const LevelOperator<float>&, const float*) const;

void CoarseSolver::solve(const Field<float>& rhs, const Field<float>& solution) const {
  multiply(shape_, pseudo_inverse_.data(), vector_.data(), rhs, solution);
}

std::size_t CoarseSolver::bytes() const {
  return (matrix_.span() + inverse_.span() + added_.span() + removed_.span()) * sizeof(Real) +
         (pseudo_inverse_.span() + vector_.span()) * sizeof(float) + connected_.span() * sizeof(Word) +
         fixed_.span() + empty_.span();
}

}  // namespace peclet::flow
