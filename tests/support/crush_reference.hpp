#pragma once
/// Reference solution of the crush model that shares no code with the library's solvers: Gragg-Bulirsch-Stoer
/// extrapolation in long double, started anew at every knot, turning point and loss of contact. On the return line of
/// plastic unloading the motion is the closed form of a linear spring.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <crashsim/crush_model.hpp>

namespace crashsim::test {

/// Motion at the times asked for, and its events.
struct CrushReference {
  std::vector<double> displacement_m, velocity_mps, accel_mps2, spring_force_n, damper_force_n;
  double t_m_s = kUnset, max_crush_m = kUnset, separation_s = kUnset;
  double return_end_m = kUnset,
         return_speed_mps = kUnset;  ///< Where the return line's force vanishes, and speed there.
};

/// One curve as a force: ordinate(|s|) s, or ordinate(|s|) sign(s), evaluated on the line of a piece wherever s is; or
/// as the factor ordinate(|s|) itself.
class ReferenceCurve {
 public:
  using Real = long double;
  /// Piece between |s| = knots[index] and the next knot, on one side of zero.
  struct Piece {
    std::size_t index = 0;
    int sign = 1;
  };

  ReferenceCurve(const PiecewiseLinear& curve, bool multiplied, Extrapolation extrapolation)
      : knots_(curve.knots.begin(), curve.knots.end()),
        ordinates_(curve.ordinates.begin(), curve.ordinates.end()),
        multiplied_(multiplied),
        linear_(extrapolation == Extrapolation::linear) {
    if (knots_.empty()) knots_ = ordinates_ = {0.0L};
  }

  /// Piece that s > 0 is in when it decreases.
  [[nodiscard]] Piece below(Real s) const {
    const auto above = std::lower_bound(knots_.begin(), knots_.end(), s);
    return {static_cast<std::size_t>(above - knots_.begin()) - 1, 1};
  }
  [[nodiscard]] Real force(Piece p, Real s) const {
    return multiplied_ ? ordinate(p, s) * s : ordinate(p, s) * static_cast<Real>(p.sign);
  }
  [[nodiscard]] Real slope(Piece p, Real s) const {
    return multiplied_ ? ordinate(p, s) + rise(p) * s * static_cast<Real>(p.sign) : rise(p);
  }
  [[nodiscard]] Real factor(Piece p, Real s) const { return ordinate(p, s); }
  [[nodiscard]] Real factor_slope(Piece p) const { return rise(p) * static_cast<Real>(p.sign); }
  [[nodiscard]] Real lower(Piece p) const { return p.sign > 0 ? knots_[p.index] : -outer(p); }
  [[nodiscard]] Real upper(Piece p) const { return p.sign > 0 ? outer(p) : -knots_[p.index]; }
  [[nodiscard]] static Piece neighbour(Piece p, int direction) {
    if (direction == p.sign) return {p.index + 1, p.sign};
    if (p.index > 0) return {p.index - 1, p.sign};
    return {0, direction};
  }

 private:
  [[nodiscard]] Real outer(Piece p) const {
    return p.index + 1 < knots_.size() ? knots_[p.index + 1] : std::numeric_limits<Real>::infinity();
  }
  [[nodiscard]] Real rise(Piece p) const {
    const bool beyond = p.index + 1 >= knots_.size();
    if (knots_.size() < 2 || (beyond && !linear_)) return 0.0L;
    const std::size_t i = beyond ? knots_.size() - 2 : p.index;
    return (ordinates_[i + 1] - ordinates_[i]) / (knots_[i + 1] - knots_[i]);
  }
  [[nodiscard]] Real ordinate(Piece p, Real s) const {
    return ordinates_[p.index] + rise(p) * (s * static_cast<Real>(p.sign) - knots_[p.index]);
  }

  std::vector<Real> knots_, ordinates_;
  bool multiplied_, linear_;
};

/// m x'' + F_k + F_c = 0 from impact, of every law.
class CrushReferenceSolver {
 public:
  using Real = ReferenceCurve::Real;

  CrushReferenceSolver(const CrushModel& model, double speed)
      : spring_(model.spring, model.law == CrushLaw::stiffness, model.extrapolation),
        damper_(over_speed(model), true, model.extrapolation),
        damping_(over_crush(model), false, model.extrapolation),
        rate_(model.law == CrushLaw::rate ? Real(model.rate_coefficient) : 0.0L),
        reference_speed_(model.law == CrushLaw::rate ? Real(model.reference_speed_mps) : 1.0L),
        mass_(model.mass_kg),
        unloading_(model.unloading),
        bilateral_(model.unloading.bilateral),
        length_(0.05L * speed),
        speed_(speed),
        y_{0.0L, speed},
        damper_piece_(damper_.below(speed)) {
    lose_contact_if_pulled();
  }

  /// @param times increasing from >= 0 [s].
  CrushReference solve(const std::vector<double>& times) {
    for (const double t : times) {
      while (t_ < t) advance(t);
      record();
    }
    return out_;
  }

 private:
  struct State {
    Real x, v;
  };
  enum class Kind { spring_knot, damping_knot, damper_knot, force_zero };
  struct Event {
    Kind kind;
    Real h;
    int direction = 0;
  };
  static constexpr Real kStepTolerance = 1e-15L, kRounding = 1e-17L, kForceRounding = 1e-15L;
  static constexpr Real kLongestStep = 5e-4L, kShortestStep = 1e-14L, kSameTime = 1e-13L;  // s

  static PiecewiseLinear over_speed(const CrushModel& model) {
    return model.law == CrushLaw::crush_damping ? PiecewiseLinear() : model.damper;
  }
  static PiecewiseLinear over_crush(const CrushModel& model) {
    return model.law == CrushLaw::crush_damping ? model.damper : PiecewiseLinear();
  }

  /// r ln(1 + |v| / v_ref), on the side of v = 0 where the motion is.
  [[nodiscard]] Real hardening(Real v) const {
    return rate_ == 0.0L ? 0.0L : rate_ * std::log1p(static_cast<Real>(damper_piece_.sign) * v / reference_speed_);
  }
  [[nodiscard]] Real hardening_slope(Real v) const {
    const auto sign = static_cast<Real>(damper_piece_.sign);
    return rate_ * sign / (reference_speed_ + sign * v);
  }
  [[nodiscard]] Real spring_force(const State& y) const { return spring_.force(spring_piece_, y.x); }
  [[nodiscard]] Real damper_force(const State& y) const {
    return spring_force(y) * hardening(y.v) + damper_.force(damper_piece_, y.v) +
           damping_.factor(damping_piece_, y.x) * y.v;
  }
  [[nodiscard]] Real force(const State& y) const { return spring_force(y) + damper_force(y); }
  [[nodiscard]] Real force_rate(const State& y) const {
    const Real by_x =
        spring_.slope(spring_piece_, y.x) * (1.0L + hardening(y.v)) + damping_.factor_slope(damping_piece_) * y.v;
    const Real by_v = spring_force(y) * hardening_slope(y.v) + damper_.slope(damper_piece_, y.v) +
                      damping_.factor(damping_piece_, y.x);
    return by_x * y.v - by_v * force(y) / mass_;
  }
  /// Force, with what rounding leaves of it taken for zero.
  [[nodiscard]] Real clean_force(const State& y) const {
    const Real spring = spring_force(y), damper = damper_force(y);
    const Real sum = spring + damper;
    const Real scale = std::abs(spring) + std::abs(damper) + mass_ * speed_ * speed_ / length_;
    return std::abs(sum) > kForceRounding * scale ? sum : 0.0L;
  }

  /// Extrapolated midpoint rule with 2, 4, ... 14 substeps, order 14; `error` is relative.
  [[nodiscard]] State step(Real h, Real* error = nullptr) const {
    constexpr std::size_t kRows = 7;
    std::array<State, kRows> table{};
    State before{};
    for (std::size_t j = 0; j < kRows; ++j) {
      const std::size_t substeps = 2 * (j + 1);
      const Real d = h / static_cast<Real>(substeps);
      State last = y_;
      State next{y_.x + d * y_.v, y_.v - d * force(y_) / mass_};
      for (std::size_t s = 1; s < substeps; ++s) {
        const State after{last.x + 2.0L * d * next.v, last.v - 2.0L * d * force(next) / mass_};
        last = std::exchange(next, after);
      }
      before = table[0];
      table[j] = next;
      for (std::size_t k = j; k > 0; --k) {
        const Real ratio = static_cast<Real>(j + 1) / static_cast<Real>(k);
        const Real weight = 1.0L / (ratio * ratio - 1.0L);
        table[k - 1] = {table[k].x + (table[k].x - table[k - 1].x) * weight,
                        table[k].v + (table[k].v - table[k - 1].v) * weight};
      }
    }
    if (error != nullptr) *error = std::abs(table[0].x - before.x) / length_ + std::abs(table[0].v - before.v) / speed_;
    return table[0];
  }

  void advance(Real end) {
    if (separated_) {
      y_.x += y_.v * (end - t_);
      t_ = end;
      return;
    }
    if (returning_) return run_back(end);
    const Real h = std::min(h_, end - t_);
    Real error = 0.0L;
    const State next = step(h, &error);
    if (!(error <= kStepTolerance)) {
      h_ = 0.5L * h;
      if (h_ < kShortestStep) throw std::runtime_error("reference motion: grows without bound");
      return;
    }
    if (const std::optional<Event> event = first_event(h, next)) {
      y_ = step(event->h);
      t_ += event->h;
      apply(*event);
      return;
    }
    y_ = next;
    t_ = h < end - t_ ? t_ + h : end;
    h_ = std::min(2.0L * h_, kLongestStep);
  }

  /// Time in [low, high] at which g falls below zero; `g(y)` and its rate `dg(y)`.
  template <class G, class Rate>
  [[nodiscard]] Real root(G g, Rate dg, Real low, Real high) const {
    Real h = 0.5L * (low + high);
    for (int i = 0; i < 80; ++i) {
      const State y = step(h);
      const Real value = g(y);
      (value > 0.0L ? low : high) = h;
      const Real newton = h - value / dg(y);
      const Real next = newton > low && newton < high ? newton : 0.5L * (low + high);
      if (std::abs(next - h) <= kRounding * high) return next;
      h = next;
    }
    return h;
  }

  [[nodiscard]] std::optional<Event> first_event(Real h, State end) const {
    std::optional<Event> first = force_zero(h, end);
    if (first) {  // v turns there: beyond it, it may have come back over a knot
      h = std::min(h, first->h + kSameTime);
      end = step(h);
    }
    const auto consider = [&](const Event& event) {
      // A force that vanishes at a knot changes sign only on the line left behind: the knot comes first.
      if (!first || event.h <= first->h + (first->kind == Kind::force_zero ? kSameTime : 0.0L)) first = event;
    };
    for (const int side : {-1, 1}) {
      const Real sign = -static_cast<Real>(side);
      const auto consider_crush = [&](Kind kind, Real bound) {
        if (sign * (end.x - bound) < -kRounding * length_)
          consider({kind,
                    root([=](const State& y) { return sign * (y.x - bound); },
                         [=](const State& y) { return sign * y.v; }, 0.0L, h),
                    side});
      };
      consider_crush(Kind::spring_knot, bound_of(spring_, spring_piece_, side));
      consider_crush(Kind::damping_knot, bound_of(damping_, damping_piece_, side));
      const Real v_bound = bound_of(damper_, damper_piece_, side);
      if (sign * (end.v - v_bound) < -kRounding * speed_)
        consider({Kind::damper_knot,
                  root([=](const State& y) { return sign * (y.v - v_bound); },
                       [=, this](const State& y) { return -sign * force(y) / mass_; }, 0.0L, h),
                  side});
    }
    return first;
  }

  /// Loss of contact; or, bilateral, where v turns.
  [[nodiscard]] std::optional<Event> force_zero(Real h, const State& end) const {
    Real low = 0.0L, high = h;
    Real at_start = clean_force(y_);
    if (at_start == 0.0L) {
      low = h / 64.0L;
      at_start = clean_force(step(low));
      if (at_start < 0.0L && !bilateral_) return Event{Kind::force_zero, 0.0L};
    }
    const Real sign = at_start < 0.0L ? -1.0L : 1.0L;
    if (at_start == 0.0L) return std::nullopt;
    if (sign * clean_force(end) >= 0.0L) {
      if (!(sign * force_rate(y_) < 0.0L && sign * force_rate(end) > 0.0L)) return std::nullopt;
      for (int i = 0; i < 40; ++i) {
        const Real middle = 0.5L * (low + high);
        (sign * force_rate(step(middle)) < 0.0L ? low : high) = middle;
      }
      if (sign * clean_force(step(high)) >= 0.0L) return std::nullopt;
      low = 0.0L;
    }
    const Real at = root([=, this](const State& y) { return sign * force(y); },
                         [=, this](const State& y) { return sign * force_rate(y); }, low, high);
    if (bilateral_ && at < 1e-6L * h) return std::nullopt;  // the turn where this step began
    return Event{Kind::force_zero, at};
  }

  static Real bound_of(const ReferenceCurve& curve, ReferenceCurve::Piece piece, int side) {
    return side < 0 ? curve.lower(piece) : curve.upper(piece);
  }

  void apply(const Event& event) {
    if (event.kind == Kind::spring_knot) {
      y_.x = bound_of(spring_, spring_piece_, event.direction);
      spring_piece_ = ReferenceCurve::neighbour(spring_piece_, event.direction);
    } else if (event.kind == Kind::damping_knot) {
      y_.x = bound_of(damping_, damping_piece_, event.direction);
      damping_piece_ = ReferenceCurve::neighbour(damping_piece_, event.direction);
    } else if (event.kind == Kind::damper_knot) {
      y_.v = bound_of(damper_, damper_piece_, event.direction);
      damper_piece_ = ReferenceCurve::neighbour(damper_piece_, event.direction);
      if (y_.v == 0.0L && event.direction < 0 && std::isnan(out_.t_m_s)) {
        out_.t_m_s = static_cast<double>(t_);
        out_.max_crush_m = static_cast<double>(y_.x);
        if (unloading_.kind == UnloadingKind::plastic) return turn_back();
      }
    } else if (!bilateral_) {
      separate();
    }
    lose_contact_if_pulled();
  }

  void turn_back() {
    const Real force = spring_.force(spring_piece_, y_.x);
    const Real e = unloading_.restitution;
    return_stiffness_ = std::isnan(unloading_.restitution) ? Real(unloading_.unloading_stiffness_n_per_m)
                                                           : force * force / (e * e * mass_ * speed_ * speed_);
    const Real swing = force / return_stiffness_;
    return_end_ = y_.x - swing;
    out_.return_end_m = static_cast<double>(return_end_);
    out_.return_speed_mps = static_cast<double>(swing * std::sqrt(return_stiffness_ / mass_));
    returning_ = true;
  }
  void run_back(Real end) {
    constexpr Real kQuarterTurn = 1.570796326794896619231321691639751442L;
    const Real frequency = std::sqrt(return_stiffness_ / mass_);
    const Real swing = static_cast<Real>(out_.max_crush_m) - return_end_;
    const Real angle = frequency * (end - static_cast<Real>(out_.t_m_s));
    const bool lets_go = !bilateral_ && angle >= kQuarterTurn;
    y_ = {return_end_ + (lets_go ? 0.0L : swing * std::cos(angle)),
          -swing * frequency * (lets_go ? 1.0L : std::sin(angle))};
    t_ = lets_go ? static_cast<Real>(out_.t_m_s) + kQuarterTurn / frequency : end;
    if (lets_go) separate();
  }

  void lose_contact_if_pulled() {
    if (!separated_ && !bilateral_ && clean_force(y_) < 0.0L) separate();
  }
  void separate() {
    separated_ = true;
    out_.separation_s = static_cast<double>(t_);
  }

  void record() {
    const Real line = return_stiffness_ * (y_.x - return_end_);
    const Real spring = separated_ ? 0.0L : returning_ ? line : spring_force(y_);
    const Real damper = separated_ || returning_ ? 0.0L : damper_force(y_);
    out_.displacement_m.push_back(static_cast<double>(y_.x));
    out_.velocity_mps.push_back(static_cast<double>(y_.v));
    out_.accel_mps2.push_back(static_cast<double>(-(spring + damper) / mass_));
    out_.spring_force_n.push_back(static_cast<double>(spring));
    out_.damper_force_n.push_back(static_cast<double>(damper));
  }

  ReferenceCurve spring_, damper_, damping_;
  Real rate_, reference_speed_;
  Real mass_;
  Unloading unloading_;
  bool bilateral_;
  Real length_, speed_;
  State y_;
  ReferenceCurve::Piece spring_piece_{}, damping_piece_{}, damper_piece_;
  bool separated_ = false, returning_ = false;
  Real return_stiffness_ = 0.0L, return_end_ = 0.0L;
  Real t_ = 0.0L, h_ = kLongestStep;
  CrushReference out_;
};

/// Motion from impact at `speed` [m/s] at the times given [s].
inline CrushReference reference_motion(const CrushModel& model, double speed, const std::vector<double>& times) {
  return CrushReferenceSolver(model, speed).solve(times);
}

}  // namespace crashsim::test
