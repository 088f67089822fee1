#pragma once
// What ViscousKrylov does on rows of cells: vectors in single precision, zero at solid points.
#include "flow/viscous_operator.hpp"

namespace peclet::flow {

/// r = shadow = scale residual, e = product = search = 0.
struct BeginKrylov {
  using Result = Norms;
  static constexpr bool may_overrun = true;
  Layout layout;
  const OpenFraction* open;
  const Real* residual;
  float *e, *r, *shadow, *search, *product;
  Real scale;

  struct Row {
    const OpenFraction* open;
    const Real* residual;
    float *e, *r, *shadow, *search, *product;
    Real scale;
    KOKKOS_INLINE_FUNCTION float operator()(int i) const {
      const float value = in_fluid(open[i], static_cast<float>(scale * residual[i]));
      r[i] = value;
      shadow[i] = value;
      e[i] = 0;
      search[i] = 0;
      product[i] = 0;
      return value;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open + n, residual + n, e + n, r + n, shadow + n, search + n, product + n, scale};
  }
};

/// search = r + beta (search - omega product), also put into rhs.
struct NewSearch {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const float *r, *product;
  float *search, *rhs;
  float beta, omega;

  struct Row {
    const float *r, *product;
    float *search, *rhs;
    float beta, omega;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const float value = r[i] + beta * (search[i] - omega * product[i]);
      search[i] = value;
      rhs[i] = value;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {r + n, product + n, search + n, rhs + n, beta, omega};
  }
};

/// out = A e
struct RegularProduct {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const float* e;
  float* out;
  Diffusion<float> d;

  struct Row {
    ProductRow product;
    float* out;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const { out[i] = product(i); }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {ProductRow(layout, e + n, d), out + n};
  }
};

struct WallProduct {
  WallRows rows;
  Field<float> e, out;
  Diffusion<float> diffusion;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (!rows.superseded(row)) out[rows.face(row)] = wall_product(rows, row, e, diffusion);
  }
};

/// a = 0 at solid points; the result is a . b.
struct MaskedDot {
  using Result = Total;
  static constexpr bool may_overrun = true;
  Layout layout;
  const OpenFraction* open;
  float* a;
  const float* b;

  struct Row {
    const OpenFraction* open;
    float* a;
    const float* b;
    KOKKOS_INLINE_FUNCTION float operator()(int i) const {
      const float value = in_fluid(open[i], a[i]);
      a[i] = value;
      return value * b[i];
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open + n, a + n, b + n};
  }
};

/// r -= step product, e += step direction; also put r into rhs, which may be the product.
struct AdvanceKrylov {
  using Result = Norms;
  static constexpr bool may_overrun = true;
  Layout layout;
  const float *direction, *product;
  float *e, *r, *rhs;
  float step;

  struct Row {
    const float *direction, *product;
    float *e, *r, *rhs;
    float step;
    KOKKOS_INLINE_FUNCTION float operator()(int i) const {
      const float value = r[i] - step * product[i];
      e[i] += step * direction[i];
      r[i] = value;
      rhs[i] = value;
      return value;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {direction + n, product + n, e + n, r + n, rhs + n, step};
  }
};

struct ScaleVector {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  float* e;
  Real factor;

  struct Row {
    float* e;
    Real factor;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const { e[i] = static_cast<float>(factor * e[i]); }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const { return {e + layout(0, j, k), factor}; }
};

}  // namespace peclet::flow
