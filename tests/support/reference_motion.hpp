#pragma once
/// An integrator of the crush model that shares no code with the library: the force from its curves by definition, and
/// classical Runge-Kutta steps that end on every knot and where contact is lost. With complex ordinates it gives
/// derivatives by complex steps: f(p + ih) = f(p) + ih f'(p), free of cancellation.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <crashsim/crush_model.hpp>

namespace crashsim::test {

inline double real_part(double value) { return value; }
inline double real_part(const std::complex<double>& value) { return value.real(); }

template <class T>
struct ReferenceSample {
  T x, v, a;
};

template <class T>
class ReferenceMotion {
 public:
  /// Ordinates instead of the model's, spring first.
  ReferenceMotion(const CrushModel& model, std::vector<T> ordinates, double speed_mps)
      : model_(model), ordinates_(std::move(ordinates)), x_(0.0), v_(speed_mps) {
    spring_ = segment(model_.spring.knots, 0.0);
    damper_ = segment(model_.damper.knots, speed_mps * (1.0 - kNudge));
  }

  /// Motion at increasing times.
  std::vector<ReferenceSample<T>> at(const std::vector<double>& times) {
    std::vector<ReferenceSample<T>> samples;
    for (const double time : times) {
      while (true) {
        const T left = T(time) - t_;
        if (real_part(left) <= 0.0) break;
        step(std::min(real_part(left), kStep) == real_part(left) ? left : T(kStep));
      }
      samples.push_back({x_, v_, acceleration(x_, v_)});
    }
    return samples;
  }

 private:
  static constexpr double kStep = 2e-5;  // s
  static constexpr double kNudge = 1e-12;

  static int segment(const std::vector<double>& knots, double s) {
    return static_cast<int>(std::upper_bound(knots.begin(), knots.end(), s) - knots.begin()) - 1;
  }

  /// Value of a curve at s >= 0 on the segment after knot `i`, beyond the last knot constant.
  T curve(const std::vector<double>& knots, std::size_t offset, int i, T s) const {
    if (knots.empty()) return T(0.0);
    const auto left = static_cast<std::size_t>(std::max(i, 0));
    if (left + 1 >= knots.size()) return ordinates_[offset + knots.size() - 1];
    const T share = (s - knots[left]) / (knots[left + 1] - knots[left]);
    return ordinates_[offset + left] * (1.0 - share) + ordinates_[offset + left + 1] * share;
  }

  T force(T x, T v) const {
    if (separated_) return T(0.0);
    const T size = real_part(v) < 0.0 ? -v : v;
    const T spring = curve(model_.spring.knots, 0, spring_, x);
    const T damper = curve(model_.damper.knots, model_.spring.knots.size(), damper_, size) * v;
    return (model_.law == CrushLaw::stiffness ? spring * x : spring) + damper;
  }
  T acceleration(T x, T v) const { return -force(x, v) / model_.mass_kg; }

  ReferenceSample<T> advanced(T h) const {
    const T half = 0.5 * h;
    const T v1 = v_, a1 = acceleration(x_, v1);
    const T v2 = v_ + half * a1, a2 = acceleration(x_ + half * v1, v2);
    const T v3 = v_ + half * a2, a3 = acceleration(x_ + half * v2, v3);
    const T v4 = v_ + h * a3, a4 = acceleration(x_ + h * v3, v4);
    const T x = x_ + h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4), v = v_ + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    return {x, v, acceleration(x, v)};
  }

  /// Whether a state has left the present segments or contact. While the car goes in, x rises and |v| falls; on the way
  /// back the other way round.
  bool has_left(const ReferenceSample<T>& s) const {
    if (separated_) return false;
    const double x = real_part(s.x), speed = std::fabs(real_part(s.v));
    const bool goes_in = real_part(s.v) > 0.0;
    const auto outside = [](const std::vector<double>& knots, int i, double value, bool rising) {
      if (knots.empty()) return false;
      if (!rising) return i > 0 && value < knots[static_cast<std::size_t>(i)];
      return i + 1 < static_cast<int>(knots.size()) && value > knots[static_cast<std::size_t>(i + 1)];
    };
    return outside(model_.spring.knots, spring_, x, goes_in) ||
           outside(model_.damper.knots, damper_, speed, !goes_in) || x < 0.0 || (real_part(v_) > 0.0) != goes_in ||
           real_part(force(s.x, s.v)) < -kNudge * model_.mass_kg;
  }

  void step(T h) {
    const ReferenceSample<T> whole = advanced(h);
    if (!has_left(whole)) return take(whole, h);
    double low = 0.0, high = real_part(h);
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (has_left(advanced(T(middle))) ? high : low) = middle;
    }
    // Forces do not jump at events but where x returns to 0: only there the event's own derivative matters.
    T to_event(high);
    const ReferenceSample<T> past = advanced(to_event);
    if (real_part(past.x) < 0.0) to_event -= past.x / past.v - real_part(past.x / past.v);
    take(advanced(to_event), to_event);
    const double x = real_part(x_), v = real_part(v_);
    spring_ = segment(model_.spring.knots, std::max(x, 0.0) + (v > 0.0 ? kNudge : -kNudge));
    damper_ = segment(model_.damper.knots, v > 0.0 ? v * (1.0 - kNudge) : -v * (1.0 + kNudge));
    if (x < 0.0 || real_part(force(x_, v_)) < -kNudge * model_.mass_kg) separated_ = true;
  }

  void take(const ReferenceSample<T>& s, T h) {
    x_ = s.x;
    v_ = s.v;
    t_ += h;
  }

  CrushModel model_;
  std::vector<T> ordinates_;
  int spring_ = 0, damper_ = 0;
  bool separated_ = false;
  T t_ = T(0.0), x_, v_;
};

}  // namespace crashsim::test
