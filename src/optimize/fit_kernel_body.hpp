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

CRASHSIM_INLINE double product_coefficient(const double* a, const double* b, int n) {
  double sum = 0.0;
  for (int i = 0; i <= n; ++i) sum += a[i] * b[n - i];
  return sum;
}

/// Features of a motion as series, and what dF/dx and dF/dv are.
struct FeatureSeries {
  Series features[kFeatures];
  Series by_x, by_v;
};

/// Laws whose force is a polynomial of x and v.
struct PolynomialLaw {
  template <class D>
  CRASHSIM_INLINE static void features(const FitPiece& /*piece*/, const D& x, const D& v, D (&out)[kFeatures]) {
    out[0] = D{} + 1.0;
    out[1] = x;
    out[2] = x * x;
    out[3] = v;
    out[4] = v * v;
    out[5] = x * v;
  }
  template <class D>
  CRASHSIM_INLINE static D by_x(const FitPiece& piece, const D (&features)[kFeatures]) {
    return piece.force[1] + 2.0 * piece.force[2] * features[1] + piece.force[5] * features[3];
  }
  template <class D>
  CRASHSIM_INLINE static D by_v(const FitPiece& piece, const D (&features)[kFeatures], const D& /*v*/) {
    return piece.force[3] + 2.0 * piece.force[4] * features[3] + piece.force[5] * features[1];
  }
  CRASHSIM_INLINE static void series(const FitPiece& piece, FeatureSeries& out) {
    const double* const force = piece.force;
#pragma GCC unroll 16
    for (int n = 0; n < kFitDegree; ++n) {
      const double one = n == 0 ? 1.0 : 0.0;
      out.features[0][n] = one;
      out.features[1][n] = piece.x[n];
      out.features[2][n] = square_coefficient(piece.x, n);
      out.features[3][n] = piece.v[n];
      out.features[4][n] = square_coefficient(piece.v, n);
      out.features[5][n] = product_coefficient(piece.x, piece.v, n);
      out.by_x[n] = one * force[1] + 2.0 * force[2] * piece.x[n] + force[5] * piece.v[n];
      out.by_v[n] = one * force[3] + 2.0 * force[4] * piece.v[n] + force[5] * piece.x[n];
    }
  }
};

/// Law `rate`.
struct RateLaw {
  template <class D>
  CRASHSIM_INLINE static void features(const FitPiece& piece, const D& x, const D& v, D (&out)[kFeatures]) {
    D log;
    for (std::size_t l = 0; l < sizeof(D) / sizeof(double); ++l) log[l] = __builtin_log1p(piece.per_reference * v[l]);
    out[0] = 1.0 + piece.rate * log;
    out[1] = x * out[0];
    out[2] = x * out[1];
    out[3] = log;
    out[4] = x * log;
    out[5] = x * out[4];
  }
  template <class D>
  CRASHSIM_INLINE static D by_x(const FitPiece& piece, const D (&features)[kFeatures]) {
    return piece.force[1] * features[0] + 2.0 * piece.force[2] * features[1];
  }
  template <class D>
  CRASHSIM_INLINE static D by_v(const FitPiece& piece, const D (&features)[kFeatures], const D& v) {
    const D hardened = piece.force[0] * features[0] + piece.force[1] * features[1] + piece.force[2] * features[2];
    return hardened / features[0] * (piece.rate * piece.per_reference) / (1.0 + piece.per_reference * v);
  }
  CRASHSIM_INLINE static void series(const FitPiece& piece, FeatureSeries& out) {
    Series argument, log, per_argument, square, spring;  // argument w = 1 + per_reference v; w L' = w', w / w = 1
    const double* const force = piece.force;
    for (int n = 0; n < kFitDegree; ++n) {
      argument[n] = piece.per_reference * piece.v[n] + (n == 0 ? 1.0 : 0.0);
      double by_log = 0.0, by_inverse = 0.0;
      for (int j = 1; j < n; ++j) by_log += static_cast<double>(j) * log[j] * argument[n - j];
      for (int j = 1; j <= n; ++j) by_inverse += argument[j] * per_argument[n - j];
      log[n] = n == 0 ? __builtin_log1p(piece.per_reference * piece.v[0])
                      : (argument[n] - by_log / static_cast<double>(n)) / argument[0];
      per_argument[n] = ((n == 0 ? 1.0 : 0.0) - by_inverse) / argument[0];
      square[n] = square_coefficient(piece.x, n);
      spring[n] = (n == 0 ? force[0] : 0.0) + force[1] * piece.x[n] + force[2] * square[n];
      out.features[0][n] = piece.rate * log[n] + (n == 0 ? 1.0 : 0.0);
      out.features[3][n] = log[n];
    }
    for (int n = 0; n < kFitDegree; ++n) {
      for (std::size_t factor = 0; factor < kFeatures; factor += 3) {
        out.features[factor + 1][n] = product_coefficient(piece.x, out.features[factor], n);
        out.features[factor + 2][n] = product_coefficient(square, out.features[factor], n);
      }
      out.by_x[n] = force[1] * out.features[0][n] + 2.0 * force[2] * out.features[1][n];
      out.by_v[n] = piece.rate * piece.per_reference * product_coefficient(spring, per_argument, n);
    }
  }
};

/// dF/dx and dF/dv per mass, negative, and the forcing of the acting parameters, as series.
struct Coupling {
  Series alpha, beta;
  Columns forcing[kFitDegree];
};

template <class Law>
CRASHSIM_INLINE void set_coupling(const FitPiece& piece, Coupling& out) {
  FeatureSeries series;
  Law::series(piece, series);
  const double per_mass = -1.0 / piece.mass;
#pragma GCC unroll 16
  for (int n = 0; n < kFitDegree; ++n) {
    out.alpha[n] = per_mass * series.by_x[n];
    out.beta[n] = per_mass * series.by_v[n];
    for (std::size_t c = 0; c < kColumnLanes; ++c) out.forcing[n][c] = 0.0;
    for (std::size_t j = 0; j < 4; ++j) {
      const double* const basis = piece.basis[j];
      const Series* const features = series.features + (j < 2 ? 0 : 3);
      out.forcing[n][2 + j] =
          per_mass * (basis[0] * features[0][n] + basis[1] * features[1][n] + basis[2] * features[2][n]);
    }
  }
}

template <class Law, std::size_t W>
CRASHSIM_INLINE void sensitivities(const FitPiece& piece, SensitivitySeries& series) {
  using D = typename Vectors<W>::Doubles;
  Coupling coupling;
  set_coupling<Law>(piece, coupling);
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
  D tau, v, features[kFeatures];
  Penalised<D> by_x, by_v, by_a;
};

template <class Law, Penalty::Kind kKind, class D>
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
  Law::features(piece, x, v, out.features);
  D force = D{};
#pragma GCC unroll 6
  for (std::size_t i = 0; i < kFeatures; ++i) force += piece.force[i] * out.features[i];
  const D a = force * (-1.0 / piece.mass);
  out.tau = tau;
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

template <class Law, Penalty::Kind kKind, std::size_t W>
CRASHSIM_INLINE void sum_losses(const FitPiece& piece, const FitSamples& samples, const Penalty& penalty,
                                PieceLoss& out) {
  using D = typename Vectors<W>::Doubles;
  Columns sums;
  for (std::size_t first = 0; first < kColumnLanes; first += W) {
    D sum = D{};
    for (std::size_t at = first; at < samples.count; at += kColumnLanes) {
      const Sampled<D> here = sample<Law, kKind, D>(piece, samples, at, penalty);
      sum += here.by_x.loss + here.by_v.loss + here.by_a.loss;
    }
    store(sum, sums + first);
  }
  out.sum = sum_of(sums);
}

/// Sums over samples, lanes still apart: losses; derivatives by x and v times powers of tau; derivatives by a times
/// the features. With these the gradient's cost per sample does not depend on the number of parameters.
struct Moments {
  Columns loss;
  Columns x[kFitDegree + 1], v[kFitDegree + 1];
  Columns a[kFeatures];
};

template <class Law, Penalty::Kind kKind, std::size_t W>
CRASHSIM_INLINE void sum_moments(const FitPiece& piece, const FitSamples& samples, const Penalty& penalty,
                                 Moments& out) {
  using D = typename Vectors<W>::Doubles;
  const double per_mass = -1.0 / piece.mass;
  for (std::size_t first = 0; first < kColumnLanes; first += W) {
    D loss = D{}, a[kFeatures];
#pragma GCC unroll 6
    for (D& sum : a) sum = D{};
    D x[kFitDegree + 1], v[kFitDegree + 1];
#pragma GCC unroll 16
    for (int n = 0; n <= kFitDegree; ++n) x[n] = v[n] = D{};
    for (std::size_t at = first; at < samples.count; at += kColumnLanes) {
      const Sampled<D> here = sample<Law, kKind, D>(piece, samples, at, penalty);
      loss += here.by_x.loss + here.by_v.loss + here.by_a.loss;
      // a follows from x and v, and from the parameters themselves.
      const D ga = here.by_a.derivative;
      D gx = here.by_x.derivative + ga * (per_mass * Law::by_x(piece, here.features));
      D gv = here.by_v.derivative + ga * (per_mass * Law::by_v(piece, here.features, here.v));
#pragma GCC unroll 6
      for (std::size_t i = 0; i < kFeatures; ++i) a[i] += ga * here.features[i];
#pragma GCC unroll 16
      for (int n = 0; n <= kFitDegree; ++n) {
        x[n] += gx;
        v[n] += gv;
        gx *= here.tau;
        gv *= here.tau;
      }
    }
    store(loss, out.loss + first);
    for (std::size_t i = 0; i < kFeatures; ++i) store(a[i], out.a[i] + first);
    for (int n = 0; n <= kFitDegree; ++n) {
      store(x[n], out.x[n] + first);
      store(v[n], out.v[n] + first);
    }
  }
}

/// Forcing of acceleration by each acting parameter, given sums of the features.
CRASHSIM_INLINE void add_forcing(const FitPiece& piece, const Moments& moments, Columns& out) {
  double sums[kFeatures];
  for (std::size_t i = 0; i < kFeatures; ++i) sums[i] = sum_of(moments.a[i]);
  const double per_mass = -1.0 / piece.mass;
  for (std::size_t j = 0; j < 4; ++j) {
    const double *const basis = piece.basis[j], *const of = sums + (j < 2 ? 0 : 3);
    out[2 + j] += per_mass * (basis[0] * of[0] + basis[1] * of[1] + basis[2] * of[2]);
  }
}

template <class Law, Penalty::Kind kKind, std::size_t W>
CRASHSIM_INLINE void sum_gradient(const FitPiece& piece, const SensitivitySeries& series, const FitSamples& samples,
                                  const Penalty& penalty, PieceLoss& out) {
  using D = typename Vectors<W>::Doubles;
  Moments moments;
  sum_moments<Law, kKind, W>(piece, samples, penalty, moments);
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
  add_forcing(piece, moments, out.gradient);
}

/// Columns of acceleration, velocity and displacement at W samples.
template <class D>
struct SampledColumns {
  D a[kColumns], v[kColumns], x[kColumns];
};

template <class Law, class D>
CRASHSIM_INLINE void sample_columns(const FitPiece& piece, const SensitivitySeries& series, const Sampled<D>& here,
                                    SampledColumns<D>& out) {
  const double per_mass = -1.0 / piece.mass;
  const D alpha = per_mass * Law::by_x(piece, here.features);
  const D beta = per_mass * Law::by_v(piece, here.features, here.v);
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
      const D* const of = here.features + (c < kHomogeneous + 2 ? 0 : 3);
      a += per_mass * (basis[0] * of[0] + basis[1] * of[1] + basis[2] * of[2]);
    }
    out.a[c] = a;
    out.v[c] = v;
    out.x[c] = x;
  }
}

template <class Law, Penalty::Kind kKind, std::size_t W>
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
      const Sampled<D> here = sample<Law, kKind, D>(piece, samples, at, penalty);
      SampledColumns<D> columns;
      sample_columns<Law>(piece, series, here, columns);
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

template <class Law, std::size_t W>
constexpr FitKernel kKernel = {
    [](const FitPiece& piece, SensitivitySeries& series) { sensitivities<Law, W>(piece, series); },
    [](const SensitivitySeries& series, double tau, Columns& x, Columns& v) { columns_at<W>(series, tau, x, v); },
    [](const FitPiece& piece, const FitSamples& samples, const Penalty& penalty, PieceLoss& out) {
      for_kind(penalty.kind, [&]<Penalty::Kind kKind>() { sum_losses<Law, kKind, W>(piece, samples, penalty, out); });
    },
    [](const FitPiece& piece, const SensitivitySeries& series, const FitSamples& samples, const Penalty& penalty,
       PieceLoss& out) {
      for_kind(penalty.kind,
               [&]<Penalty::Kind kKind>() { sum_gradient<Law, kKind, W>(piece, series, samples, penalty, out); });
    },
    [](const FitPiece& piece, const SensitivitySeries& series, const FitSamples& samples, const Penalty& penalty,
       PieceLoss& out) {
      for_kind(penalty.kind, [&]<Penalty::Kind kKind>() {
        sum_normal_equations<Law, kKind, W>(piece, series, samples, penalty, out);
      });
    }};

}  // namespace
}  // namespace crashsim
