#pragma once
/// Reference solution of the coupled model that shares no code with the library's solvers: classical Runge-Kutta in
/// long double with every force written as it is defined, kinks and all, and steps that end on each kink.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <crashsim/simulate_coupled.hpp>
#include <crashsim/units.hpp>

namespace crashsim::test {

class CoupledReference {
 public:
  using Real = long double;
  /// x, z, theta and their rates.
  using State = std::array<Real, 6>;

  CoupledReference(const CoupledModel& model, double speed_mps, TimeSeries vertical_force_n = {})
      : model_(with_one_mass(model)), body_(with_axle_values(model_.body)), series_(std::move(vertical_force_n)) {
    const Real weight = body_.mass_kg * kStandardGravity;
    const Real length = body_.front_axle_m + body_.rear_axle_m;
    const GroundContact& g = model_.ground;
    axles_ = {Axle{-body_.front_axle_m, body_.front_stiffness_n_per_m, body_.front_damping_ns_per_m,
                   weight * body_.rear_axle_m / length, g.front_bump_gap_m, g.front_bump_stiffness_n_per_m},
              Axle{body_.rear_axle_m, body_.rear_stiffness_n_per_m, body_.rear_damping_ns_per_m,
                   weight * body_.front_axle_m / length, g.rear_bump_gap_m, g.rear_bump_stiffness_n_per_m}};
    y_[3] = speed_ = speed_mps;
    line_ = line(t_);
    kinks_ = kinks(t_, y_);
    pull_tolerance_ = 1e-15L * body_.mass_kg * speed_mps * 20.0L;
  }

  /// States at increasing times.
  std::vector<State> at(const std::vector<double>& times) {
    std::vector<State> states;
    for (const double time : times) {
      while (t_ < time) step(std::min(kStep, time - t_));
      states.push_back(y_);
    }
    return states;
  }

  [[nodiscard]] double t_m_s() const { return t_m_s_; }
  [[nodiscard]] double max_crush_m() const { return max_crush_m_; }
  [[nodiscard]] double separation_s() const { return separation_s_; }
  [[nodiscard]] Real axle_load(std::size_t axle, const State& y) const {
    const Real load = spring_and_damper(axles_[axle], y);
    return model_.ground.lift_off ? std::max(load, 0.0L) : load;
  }

 private:
  static constexpr Real kStep = 5e-6L;  // s
  struct Axle {
    Real place, stiffness, damping, static_load, gap, bump;
  };
  using Kinks = std::array<int, 11>;

  static Real rise(const Axle& axle, const State& y) { return y[1] + axle.place * y[2]; }
  static Real rise_rate(const Axle& axle, const State& y) { return y[4] + axle.place * y[5]; }
  static bool on_stop(const Axle& axle, const State& y) { return -rise(axle, y) > axle.gap; }  // NaN: never
  static Real spring_and_damper(const Axle& axle, const State& y) {
    Real load = axle.static_load - axle.stiffness * rise(axle, y) - axle.damping * rise_rate(axle, y);
    if (on_stop(axle, y)) load += axle.bump * (-rise(axle, y) - axle.gap);
    return load;
  }

  static int segment(const PiecewiseLinear& curve, Real s) {
    const auto above = std::upper_bound(curve.knots.begin(), curve.knots.end(), std::abs(s));
    const auto index = static_cast<int>(above - curve.knots.begin());
    return s < 0.0L ? -index : index;
  }
  [[nodiscard]] Real ordinate(const PiecewiseLinear& curve, Real s) const {
    const auto n = curve.knots.size();
    if (n == 0) return 0.0L;
    std::size_t i = static_cast<std::size_t>(std::abs(segment(curve, s))) - 1;
    if (i + 1 >= n && (n == 1 || model_.crush.extrapolation != Extrapolation::linear)) return curve.ordinates.back();
    i = std::min(i, n - 2);
    const Real left = curve.knots[i], low = curve.ordinates[i];
    return low + (curve.ordinates[i + 1] - low) * (s * (s < 0.0L ? -1.0L : 1.0L) - left) / (curve.knots[i + 1] - left);
  }

  [[nodiscard]] Real height() const { return static_cast<Real>(body_.force_height_m) - body_.cg_height_m; }
  [[nodiscard]] Real crush(const State& y) const { return y[0] + height() * y[2]; }
  [[nodiscard]] Real crush_rate(const State& y) const { return y[3] + height() * y[5]; }
  [[nodiscard]] Real longitudinal(const State& y) const {
    if (separated_) return 0.0L;
    if (return_stiffness_ > 0.0L) return max_force_ - return_stiffness_ * (max_crush_m_ - crush(y));
    const Real s = crush(y), rate = crush_rate(y);
    const Real k = ordinate(model_.crush.spring, s);
    const Real spring = model_.crush.law == CrushLaw::stiffness ? k * s : (behind_ ? -k : k);
    switch (model_.crush.law) {
      case CrushLaw::crush_damping:
        return spring + ordinate(model_.crush.damper, s) * rate;
      case CrushLaw::rate:
        return spring *
               (1.0L + model_.crush.rate_coefficient * std::log1p(std::abs(rate) / model_.crush.reference_speed_mps));
      case CrushLaw::stiffness:
      case CrushLaw::force:
        break;
    }
    return spring + ordinate(model_.crush.damper, rate) * rate;
  }
  [[nodiscard]] Real angle(const State& y) const {
    const VerticalForceLaw& law = model_.vertical;
    return law.angle_rad + law.angle_rate_rad_per_m * std::max(0.0L, crush(y) - law.angle_start_m);
  }
  [[nodiscard]] Real vertical(Real t, const State& y) const {
    const auto i = static_cast<std::size_t>(line_);
    if (i > 0 && i < series_.time_s.size()) {
      const Real from = series_.time_s[i - 1], low = series_.values[i - 1];
      return low + (series_.values[i] - low) * (t - from) / (series_.time_s[i] - from);
    }
    if (!series_.empty()) return 0.0L;
    const Real ratio = std::tan(angle(y)), friction = model_.vertical.friction;
    return longitudinal(y) * (std::isnan(friction) ? ratio : std::clamp(ratio, -friction, friction));
  }
  [[nodiscard]] int line(Real t) const {
    return static_cast<int>(std::upper_bound(series_.time_s.begin(), series_.time_s.end(), t) - series_.time_s.begin());
  }

  /// On which side of each kink a state is.
  [[nodiscard]] Kinks kinks(Real t, const State& y) const {
    Kinks k{};
    if (!separated_) {
      const Real friction = model_.vertical.friction, ratio = std::tan(angle(y));
      k = {segment(model_.crush.spring, crush(y)),
           segment(model_.crush.damper, model_.crush.law == CrushLaw::crush_damping ? crush(y) : crush_rate(y)),
           crush_rate(y) < 0.0L ? 1 : 0,
           crush(y) < 0.0L ? 1 : 0,
           longitudinal(y) < -pull_tolerance_ ? 1 : 0,
           crush(y) > model_.vertical.angle_start_m ? 1 : 0,
           ratio > friction ? 1 : (ratio < -friction ? -1 : 0)};
    }
    for (std::size_t i = 0; i < 2; ++i) {
      k[7 + 2 * i] = on_stop(axles_[i], y) ? 1 : 0;
      k[8 + 2 * i] = model_.ground.lift_off && spring_and_damper(axles_[i], y) < 0.0L ? 1 : 0;
    }
    if (!series_.empty()) k[0] += 1000 * line(t);
    return k;
  }

  [[nodiscard]] State rates(Real t, const State& y) const {
    const Real fx = longitudinal(y), fv = vertical(t, y);
    const Real front = axle_load(0, y) - axles_[0].static_load, rear = axle_load(1, y) - axles_[1].static_load;
    const Real arm = fv == 0.0L ? 0.0L : static_cast<Real>(body_.force_arm_m);
    const Real moment = -fx * height() + fv * arm - body_.front_axle_m * front + body_.rear_axle_m * rear;
    return {
        y[3], y[4], y[5], -fx / body_.mass_kg, (front + rear - fv) / body_.mass_kg, moment / body_.pitch_inertia_kgm2};
  }

  [[nodiscard]] State advanced(Real h) const {
    const auto moved = [&](Real by, const State& rate) {
      State y = y_;
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += by * rate[i];
      return y;
    };
    const State k1 = rates(t_, y_), k2 = rates(t_ + 0.5L * h, moved(0.5L * h, k1));
    const State k3 = rates(t_ + 0.5L * h, moved(0.5L * h, k2)), k4 = rates(t_ + h, moved(h, k3));
    State sum{};
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = (k1[i] + 2.0L * (k2[i] + k3[i]) + k4[i]) / 6.0L;
    return moved(h, sum);
  }

  void step(Real h) {
    State next = advanced(h);
    if (kinks(t_ + h, next) == kinks_) {
      y_ = next;
      t_ += h;
      return;
    }
    Real low = 0.0L;
    for (int i = 0; i < 64; ++i) {
      const Real middle = 0.5L * (low + h);
      const State there = advanced(middle);
      if (kinks(t_ + middle, there) == kinks_) {
        low = middle;
      } else {
        h = middle;
        next = there;
      }
    }
    const bool moved_in = crush_rate(y_) >= 0.0L;
    y_ = next;
    t_ += h;
    behind_ = crush(y_) < 0.0L;
    line_ = line(t_);
    if (moved_in && crush_rate(y_) < 0.0L && std::isnan(t_m_s_) && !separated_) {
      t_m_s_ = static_cast<double>(t_);
      max_crush_m_ = static_cast<double>(crush(y_));
      unload();
    }
    if (!separated_ && !model_.crush.unloading.bilateral && longitudinal(y_) < -pull_tolerance_) {
      separated_ = true;
      separation_s_ = static_cast<double>(t_);
    }
    kinks_ = kinks(t_, y_);
  }

  /// The straight line back from maximum crush, where the model asks for it.
  void unload() {
    const Unloading& unloading = model_.crush.unloading;
    if (unloading.kind != UnloadingKind::plastic) return;
    max_force_ = longitudinal(y_);  // at rest: the spring's alone
    const Real share = unloading.restitution * speed_;
    return_stiffness_ = std::isnan(unloading.unloading_stiffness_n_per_m)
                            ? max_force_ * max_force_ / (share * share * body_.mass_kg)
                            : static_cast<Real>(unloading.unloading_stiffness_n_per_m);
  }

  CoupledModel model_;
  HeavePitchModel body_;
  TimeSeries series_;
  std::array<Axle, 2> axles_{};
  bool separated_ = false;
  // Sides of what forces jump at, kept within a step: s < 0, where a yield force has the other sign, and the series.
  bool behind_ = false;
  int line_ = 0;
  Real pull_tolerance_ = 0.0L, t_ = 0.0L;
  Real speed_ = 0.0L, max_force_ = 0.0L, return_stiffness_ = 0.0L;
  State y_{};
  Kinks kinks_{};
  double t_m_s_ = kUnset, max_crush_m_ = kUnset, separation_s_ = kUnset;
};

}  // namespace crashsim::test
