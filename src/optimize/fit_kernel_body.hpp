#pragma once
/// The kernel, for the files that compile it for one instruction set each; see instruction_set.hpp.

#include "optimize/fit_kernel.hpp"
#include "vector_types.hpp"

namespace crashsim {
namespace {

CRASHSIM_INLINE double square_coefficient(const double* c, int n) {
  double sum = 0.0;
  for (int i = 0; 2 * i < n; ++i) sum += c[i] * c[n - i];
  sum += sum;
  return n % 2 == 0 ? sum + c[n / 2] * c[n / 2] : sum;
}

/// dF/dx and dF/dv per mass, negative, and the forcing of the acting ordinates, as series.
struct Coupling {
  Series alpha, beta;
  Columns forcing[kFitDegree];
};

CRASHSIM_INLINE void set_coupling(const FitPiece& piece, Coupling& out) {
  const double per_mass = -1.0 / piece.mass;
  const double x2 = 2.0 * per_mass * piece.spring[2], v2 = 2.0 * per_mass * piece.damper[2];
#pragma GCC unroll 16
  for (int n = 0; n < kFitDegree; ++n) {
    out.alpha[n] = x2 * piece.x[n];
    out.beta[n] = v2 * piece.v[n];
    const double xx = square_coefficient(piece.x, n), vv = square_coefficient(piece.v, n);
    for (std::size_t c = 0; c < kColumnLanes; ++c) out.forcing[n][c] = 0.0;
    for (std::size_t j = 0; j < 2; ++j) {
      const double *const spring = piece.basis[j], *const damper = piece.basis[2 + j];
      out.forcing[n][2 + j] = per_mass * (spring[1] * piece.x[n] + spring[2] * xx);
      out.forcing[n][4 + j] = per_mass * (damper[1] * piece.v[n] + damper[2] * vv);
      if (n > 0) continue;
      out.forcing[0][2 + j] += per_mass * spring[0];
      out.forcing[0][4 + j] += per_mass * damper[0];
    }
  }
  out.alpha[0] += per_mass * piece.spring[1];
  out.beta[0] += per_mass * piece.damper[1];
}

template <std::size_t W>
CRASHSIM_INLINE void sensitivities(const FitPiece& piece, SensitivitySeries& series) {
  using D = typename Vectors<W>::Doubles;
  Coupling coupling;
  set_coupling(piece, coupling);
  constexpr Columns kUnitX = {1.0}, kUnitV = {0.0, 1.0};
  for (std::size_t first = 0; first < kColumns; first += W) {
    D x[kFitDegree + 1], v[kFitDegree + 1];
    x[0] = load<D>(kUnitX + first);
    v[0] = load<D>(kUnitV + first);
#pragma GCC unroll 16
    for (int n = 0; n < kFitDegree; ++n) {
      D by_x = coupling.alpha[0] * x[n], by_v = coupling.beta[0] * v[n];
#pragma GCC unroll 16
      for (int i = 1; i <= n; ++i) {
        by_x += coupling.alpha[i] * x[n - i];
        by_v += coupling.beta[i] * v[n - i];
      }
      const double factor = 1.0 / static_cast<double>(n + 1);
      x[n + 1] = v[n] * factor;
      v[n + 1] = (load<D>(coupling.forcing[n] + first) + (by_x + by_v)) * factor;
    }
    for (int n = 0; n <= kFitDegree; ++n) {
      store(x[n], series.x[n] + first);
      store(v[n], series.v[n] + first);
    }
  }
}

template <std::size_t W>
CRASHSIM_INLINE void columns_at(const SensitivitySeries& series, double tau, Columns& x_out, Columns& v_out) {
  using D = typename Vectors<W>::Doubles;
  for (std::size_t first = 0; first < kColumns; first += W) {
    D x = load<D>(series.x[kFitDegree] + first), v = load<D>(series.v[kFitDegree] + first);
#pragma GCC unroll 16
    for (int n = kFitDegree - 1; n >= 0; --n) {
      x = x * tau + load<D>(series.x[n] + first);
      v = v * tau + load<D>(series.v[n] + first);
    }
    store(x, x_out + first);
    store(v, v_out + first);
  }
}

template <class D>
CRASHSIM_INLINE D root_of(const D& square) {
  D root;
  for (std::size_t l = 0; l < sizeof(D) / sizeof(double); ++l) root[l] = __builtin_sqrt(square[l]);
  return root;
}

/// Loss of one channel, its derivative by the channel, and the weight that Gauss-Newton gives it.
template <class D>
struct Penalised {
  D loss, derivative, weight;
};

template <Penalty::Kind kKind, class D>
CRASHSIM_INLINE Penalised<D> penalise(const D& residual, double scale, double rounding) {
  const D u = scale * residual;
  if constexpr (kKind == Penalty::squared) {
    return {u * u, 2.0 * scale * u, D{} + 2.0 * scale * scale};
  } else if constexpr (kKind == Penalty::rounded) {
    const D root = root_of(D(u * u + rounding * rounding));
    const D weight = scale / root;
    return {root - rounding, u * weight, scale * weight};
  } else {
    const D size = size_of(u), one = D{} + 1.0;
    const D sign = (u > 0.0 ? one : D{}) - (u < 0.0 ? one : D{});
    if constexpr (kKind == Penalty::absolute) return {size, scale * sign, D{}};
    const auto is_small = size <= rounding;
    const D bound = is_small ? D{} + rounding : size;
    return {is_small ? 0.5 / rounding * u * u : size - 0.5 * rounding, scale * (is_small ? u / rounding : sign),
            scale * scale / bound};
  }
}

template <class D>
CRASHSIM_INLINE void clear_beyond(std::size_t count, Penalised<D>& out) {
  for (std::size_t l = 0; l < sizeof(D) / sizeof(double); ++l)
    if (l >= count) out.loss[l] = out.derivative[l] = out.weight[l] = 0.0;
}

/// Motion of W samples, from `at` on, with their residuals penalised; zero for those beyond the last.
template <class D>
struct Sampled {
  D tau, x, v;
  Penalised<D> by_x, by_v, by_a;
};

template <Penalty::Kind kKind, class D>
CRASHSIM_INLINE Sampled<D> sample(const FitPiece& piece, const FitSamples& samples, std::size_t at,
                                  const Penalty& penalty) {
  Sampled<D> out;
  const D tau = load<D>(samples.time + at) - samples.base;
  D x = D{} + piece.x[kFitDegree], v = D{} + piece.v[kFitDegree];
#pragma GCC unroll 16
  for (int n = kFitDegree - 1; n >= 0; --n) {
    x = x * tau + piece.x[n];
    v = v * tau + piece.v[n];
  }
  const D spring = piece.spring[0] + x * (piece.spring[1] + x * piece.spring[2]);
  const D damper = piece.damper[0] + v * (piece.damper[1] + v * piece.damper[2]);
  const D a = (spring + damper) * (-1.0 / piece.mass);
  out.tau = tau;
  out.x = x;
  out.v = v;
  out.by_x = penalise<kKind, D>(x - load<D>(samples.displacement + at), penalty.displacement_scale,
                                penalty.displacement_rounding);
  out.by_v = penalise<kKind, D>(v - load<D>(samples.velocity + at), penalty.velocity_scale, penalty.velocity_rounding);
  out.by_a = penalise<kKind, D>(a - load<D>(samples.accel + at), penalty.accel_scale, penalty.accel_rounding);
  if (at + sizeof(D) / sizeof(double) > samples.count) {
    clear_beyond(samples.count - at, out.by_x);
    clear_beyond(samples.count - at, out.by_v);
    clear_beyond(samples.count - at, out.by_a);
  }
  return out;
}

CRASHSIM_INLINE double sum_of(const Columns& lanes) {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

template <Penalty::Kind kKind, std::size_t W>
CRASHSIM_INLINE void sum_losses(const FitPiece& piece, const FitSamples& samples, const Penalty& penalty,
                                PieceLoss& out) {
  using D = typename Vectors<W>::Doubles;
  Columns sums;
  for (std::size_t first = 0; first < kColumnLanes; first += W) {
    D sum = D{};
    for (std::size_t at = first; at < samples.count; at += kColumnLanes) {
      const Sampled<D> here = sample<kKind, D>(piece, samples, at, penalty);
      sum += here.by_x.loss + here.by_v.loss + here.by_a.loss;
    }
    store(sum, sums + first);
  }
  out.sum = sum_of(sums);
}

/// Sums over samples, lanes still apart: losses; derivatives by x and v times powers of tau; derivatives by a times
/// powers of x and v. With these the gradient's cost per sample does not depend on the number of parameters.
struct Moments {
  Columns loss;
  Columns x[kFitDegree + 1], v[kFitDegree + 1];
  Columns a, ax, axx, av, avv;
};

template <Penalty::Kind kKind, std::size_t W>
CRASHSIM_INLINE void sum_moments(const FitPiece& piece, const FitSamples& samples, const Penalty& penalty,
                                 Moments& out) {
  using D = typename Vectors<W>::Doubles;
  const double per_mass = -1.0 / piece.mass;
  for (std::size_t first = 0; first < kColumnLanes; first += W) {
    D loss = D{}, a = D{}, ax = D{}, axx = D{}, av = D{}, avv = D{};
    D x[kFitDegree + 1], v[kFitDegree + 1];
#pragma GCC unroll 16
    for (int n = 0; n <= kFitDegree; ++n) x[n] = v[n] = D{};
    for (std::size_t at = first; at < samples.count; at += kColumnLanes) {
      const Sampled<D> here = sample<kKind, D>(piece, samples, at, penalty);
      loss += here.by_x.loss + here.by_v.loss + here.by_a.loss;
      // a follows from x and v, and from the ordinates themselves.
      const D ga = here.by_a.derivative;
      D gx = here.by_x.derivative + ga * (per_mass * (piece.spring[1] + 2.0 * piece.spring[2] * here.x));
      D gv = here.by_v.derivative + ga * (per_mass * (piece.damper[1] + 2.0 * piece.damper[2] * here.v));
      const D gax = ga * here.x, gav = ga * here.v;
      a += ga;
      ax += gax;
      axx += gax * here.x;
      av += gav;
      avv += gav * here.v;
#pragma GCC unroll 16
      for (int n = 0; n <= kFitDegree; ++n) {
        x[n] += gx;
        v[n] += gv;
        gx *= here.tau;
        gv *= here.tau;
      }
    }
    store(loss, out.loss + first);
    store(a, out.a + first);
    store(ax, out.ax + first);
    store(axx, out.axx + first);
    store(av, out.av + first);
    store(avv, out.avv + first);
    for (int n = 0; n <= kFitDegree; ++n) {
      store(x[n], out.x[n] + first);
      store(v[n], out.v[n] + first);
    }
  }
}

/// Forcing of acceleration by each acting ordinate, given sums or values of 1, x, x^2 and v, v^2.
CRASHSIM_INLINE void add_forcing(const FitPiece& piece, const double (&of_x)[3], const double (&of_v)[3],
                                 Columns& out) {
  const double per_mass = -1.0 / piece.mass;
  for (std::size_t j = 0; j < 2; ++j) {
    const double *const spring = piece.basis[j], *const damper = piece.basis[2 + j];
    out[2 + j] += per_mass * (spring[0] * of_x[0] + spring[1] * of_x[1] + spring[2] * of_x[2]);
    out[4 + j] += per_mass * (damper[0] * of_v[0] + damper[1] * of_v[1] + damper[2] * of_v[2]);
  }
}

template <Penalty::Kind kKind, std::size_t W>
CRASHSIM_INLINE void sum_gradient(const FitPiece& piece, const SensitivitySeries& series, const FitSamples& samples,
                                  const Penalty& penalty, PieceLoss& out) {
  using D = typename Vectors<W>::Doubles;
  Moments moments;
  sum_moments<kKind, W>(piece, samples, penalty, moments);
  out.sum = sum_of(moments.loss);
  Series by_x, by_v;
  for (int n = 0; n <= kFitDegree; ++n) {
    by_x[n] = sum_of(moments.x[n]);
    by_v[n] = sum_of(moments.v[n]);
  }
  for (std::size_t first = 0; first < kColumnLanes; first += W) {
    D sum = D{};
    if (first < kColumns)
      for (int n = 0; n <= kFitDegree; ++n)
        sum += by_x[n] * load<D>(series.x[n] + first) + by_v[n] * load<D>(series.v[n] + first);
    store(sum, out.gradient + first);
  }
  const double a = sum_of(moments.a);
  add_forcing(piece, {a, sum_of(moments.ax), sum_of(moments.axx)}, {a, sum_of(moments.av), sum_of(moments.avv)},
              out.gradient);
}

/// Columns of acceleration, velocity and displacement at W samples.
template <class D>
struct SampledColumns {
  D a[kColumns], v[kColumns], x[kColumns];
};

template <class D>
CRASHSIM_INLINE void sample_columns(const FitPiece& piece, const SensitivitySeries& series, const Sampled<D>& here,
                                    SampledColumns<D>& out) {
  const double per_mass = -1.0 / piece.mass;
  const D alpha = per_mass * (piece.spring[1] + 2.0 * piece.spring[2] * here.x);
  const D beta = per_mass * (piece.damper[1] + 2.0 * piece.damper[2] * here.v);
#pragma GCC unroll 6
  for (std::size_t c = 0; c < kColumns; ++c) {
    D x = D{} + series.x[kFitDegree][c], v = D{} + series.v[kFitDegree][c];
#pragma GCC unroll 16
    for (int n = kFitDegree - 1; n >= 0; --n) {
      x = x * here.tau + series.x[n][c];
      v = v * here.tau + series.v[n][c];
    }
    D a = alpha * x + beta * v;
    if (c >= kHomogeneous) {
      const double* const basis = piece.basis[c - kHomogeneous];
      const D s = c < kHomogeneous + 2 ? here.x : here.v;
      a += per_mass * (basis[0] + s * (basis[1] + s * basis[2]));
    }
    out.a[c] = a;
    out.v[c] = v;
    out.x[c] = x;
  }
}

template <Penalty::Kind kKind, std::size_t W>
CRASHSIM_INLINE void sum_normal_equations(const FitPiece& piece, const SensitivitySeries& series,
                                          const FitSamples& samples, const Penalty& penalty, PieceLoss& out) {
  using D = typename Vectors<W>::Doubles;
  Columns loss_lanes, gradient_lanes[kColumns], hessian_lanes[kColumns][kColumns];
  for (std::size_t first = 0; first < kColumnLanes; first += W) {
    D loss = D{}, gradient[kColumns], hessian[kColumns][kColumns];
#pragma GCC unroll 6
    for (std::size_t row = 0; row < kColumns; ++row) {
      gradient[row] = D{};
#pragma GCC unroll 6
      for (std::size_t c = row; c < kColumns; ++c) hessian[row][c] = D{};
    }
    for (std::size_t at = first; at < samples.count; at += kColumnLanes) {
      const Sampled<D> here = sample<kKind, D>(piece, samples, at, penalty);
      SampledColumns<D> columns;
      sample_columns(piece, series, here, columns);
      loss += here.by_x.loss + here.by_v.loss + here.by_a.loss;
#pragma GCC unroll 6
      for (std::size_t row = 0; row < kColumns; ++row) {
        gradient[row] += here.by_a.derivative * columns.a[row] + here.by_v.derivative * columns.v[row] +
                         here.by_x.derivative * columns.x[row];
        const D a = here.by_a.weight * columns.a[row], v = here.by_v.weight * columns.v[row],
                x = here.by_x.weight * columns.x[row];
#pragma GCC unroll 6
        for (std::size_t c = row; c < kColumns; ++c)
          hessian[row][c] += a * columns.a[c] + v * columns.v[c] + x * columns.x[c];
      }
    }
    store(loss, loss_lanes + first);
#pragma GCC unroll 6
    for (std::size_t row = 0; row < kColumns; ++row) {
      store(gradient[row], gradient_lanes[row] + first);
#pragma GCC unroll 6
      for (std::size_t c = row; c < kColumns; ++c) store(hessian[row][c], hessian_lanes[row][c] + first);
    }
  }
  out.sum = sum_of(loss_lanes);
  for (std::size_t row = 0; row < kColumns; ++row) {
    out.gradient[row] = sum_of(gradient_lanes[row]);
    for (std::size_t c = row; c < kColumns; ++c)
      out.hessian[row][c] = out.hessian[c][row] = sum_of(hessian_lanes[row][c]);
  }
}

/// Calls f with the kind as a constant.
template <class F>
CRASHSIM_INLINE void for_kind(Penalty::Kind kind, const F& f) {
  switch (kind) {
    case Penalty::absolute:
      return f.template operator()<Penalty::absolute>();
    case Penalty::rounded:
      return f.template operator()<Penalty::rounded>();
    case Penalty::squared:
      return f.template operator()<Penalty::squared>();
    case Penalty::huber:
      return f.template operator()<Penalty::huber>();
  }
}

template <std::size_t W>
constexpr FitKernel kKernel = {
    [](const FitPiece& piece, SensitivitySeries& series) { sensitivities<W>(piece, series); },
    [](const SensitivitySeries& series, double tau, Columns& x, Columns& v) { columns_at<W>(series, tau, x, v); },
    [](const FitPiece& piece, const FitSamples& samples, const Penalty& penalty, PieceLoss& out) {
      for_kind(penalty.kind, [&]<Penalty::Kind kKind>() { sum_losses<kKind, W>(piece, samples, penalty, out); });
    },
    [](const FitPiece& piece, const SensitivitySeries& series, const FitSamples& samples, const Penalty& penalty,
       PieceLoss& out) {
      for_kind(penalty.kind,
               [&]<Penalty::Kind kKind>() { sum_gradient<kKind, W>(piece, series, samples, penalty, out); });
    },
    [](const FitPiece& piece, const SensitivitySeries& series, const FitSamples& samples, const Penalty& penalty,
       PieceLoss& out) {
      for_kind(penalty.kind,
               [&]<Penalty::Kind kKind>() { sum_normal_equations<kKind, W>(piece, series, samples, penalty, out); });
    }};

}  // namespace
}  // namespace crashsim
