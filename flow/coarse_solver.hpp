#pragma once
// Direct solution on the coarsest level.
#include "flow/poisson_operator.hpp"

namespace peclet::flow {

/// Applies the pseudo-inverse of the operator: on every connected region that no Fixed side touches, the mean
/// of the right-hand side is ignored and the mean of the solution is zero.
class CoarseSolver {
 public:
  static constexpr int largest_size = 128;
  using Word = std::uint64_t;

  CoarseSolver() = default;
  explicit CoarseSolver(const LevelShape& shape);

  /// reaction: added to the diagonal, unless null.
  template <class Coefficient>
  void set_operator(const LevelOperator<Coefficient>& op, const float* reaction = nullptr) const;
  void solve(const Field<float>& rhs, const Field<float>& solution) const;
  std::size_t bytes() const;

 private:
  LevelShape shape_;
  Array<Real> matrix_, inverse_;
  Array<Word> connected_;
  Array<unsigned char> fixed_, empty_;
  Array<Real> added_, removed_;
  Array<float> pseudo_inverse_, vector_;
};

}  // namespace peclet::flow
