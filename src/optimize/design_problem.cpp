#include "optimize/design_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace crashsim {
namespace {

constexpr double kAccuracy = 1e-10;     // rtol of every run
constexpr double kGradientStep = 5e-4;  // of the box: near the cube root of kAccuracy, where a difference errs least
constexpr double kFirstStep = 0.02;     // of the parameter: coarse, as it is halved and extrapolated
constexpr double kLeastScale = 0.1;     // of the range: what stands for a parameter near 0
constexpr std::size_t kHalvings = 4;

/// A table of differences over h, h/2, .. on its way to h = 0; keeps the entry that its neighbours confirm best.
class DifferenceTable {
 public:
  /// @param ratio by which halving the step divides the leading error; the following one by `growth` times as much.
  DifferenceTable(double ratio, double growth) : ratio_(ratio), growth_(growth) {}

  void add(double difference) {
    std::array<double, kHalvings> row{difference};
    double ratio = ratio_;
    for (std::size_t k = 1; k <= rows_; ++k, ratio *= growth_) {
      row[k] = row[k - 1] + (row[k - 1] - last_[k - 1]) / (ratio - 1.0);
      const double error = std::max(std::fabs(row[k] - row[k - 1]), std::fabs(row[k] - last_[k - 1]));
      if (error <= error_) {
        value_ = row[k];
        error_ = error;
      }
    }
    last_ = row;
    ++rows_;
  }
  /// Unset when a difference was.
  [[nodiscard]] double value() const { return value_; }
  [[nodiscard]] double error() const { return std::isnan(value_) ? kUnset : error_; }

 private:
  double ratio_, growth_;
  std::array<double, kHalvings> last_{};
  std::size_t rows_ = 0;
  double value_ = kUnset, error_ = std::numeric_limits<double>::infinity();
};

/// Where a difference over a step is taken: on both sides, or on the one where a parameter may be.
struct Sides {
  double above, below;  ///< In steps.
};
Sides sides_for(const DesignParameter& parameter, double value, double step) {
  if (value - step < parameter.allowed.min) return {1.0, 0.0};
  if (value + step > parameter.allowed.max) return {0.0, -1.0};
  return {1.0, -1.0};
}

/// Slope at 0 of the parabola through (0, at), (a, at_a), (b, at_b); 0 where there is none.
double slope(double at, double a, double at_a, double b, double at_b) {
  const double d = ((at_a - at) * b / a - (at_b - at) * a / b) / (b - a);
  return std::isfinite(d) ? d : 0.0;
}

}  // namespace

DesignProblem::DesignProblem(CoupledModel model, const CoupledOptions& simulation,
                             std::vector<DesignParameter> parameters)
    : model_(std::move(model)), simulation_(simulation), parameters_(std::move(parameters)) {
  simulation_.rtol = kAccuracy;
}

CoupledModel DesignProblem::model_at(std::span<const double> point) const {
  CoupledModel model = model_;
  for (std::size_t i = 0; i < point.size(); ++i) set_value(model, parameters_[i], parameters_[i].value_at(point[i]));
  return model;
}

CoupledResponse DesignProblem::simulate(const CoupledModel& model) const {
  ++simulations_;
  return simulate_coupled(model, simulation_);
}

std::vector<double> DesignProblem::given_point() const {
  std::vector<double> point;
  for (const DesignParameter& parameter : parameters_) point.push_back(parameter.place_of(value_of(model_, parameter)));
  return point;
}

void DesignProblem::evaluate(const DesignGoal& goal, std::span<const double> point, std::span<double> values) const {
  const DesignResponses responses = design_responses(simulate(model_at(point)));
  values[0] = quantity_of(responses, goal.minimise) / goal.scale;
  for (std::size_t i = 0; i < goal.limits.size(); ++i)
    values[i + 1] = quantity_of(responses, goal.limits[i].quantity) / goal.limits[i].value - 1.0;
  if (std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) return;
  values[0] = std::numeric_limits<double>::infinity();
  std::ranges::fill(values.subspan(1), 1.0);
}

ConstrainedFunction DesignProblem::function(const DesignGoal& goal) const {
  return [this, goal](std::span<const double> point, std::span<double> values, std::span<double> gradients) {
    evaluate(goal, point, values);
    if (gradients.empty()) return;
    std::vector<double> moved(point.begin(), point.end()), at_a(values.size()), at_b(values.size());
    for (std::size_t j = 0; j < point.size(); ++j) {
      double a = -kGradientStep, b = kGradientStep;
      if (point[j] + a < 0.0) a = 2.0 * kGradientStep;
      if (point[j] + b > 1.0) b = -2.0 * kGradientStep;
      moved[j] = point[j] + a;
      evaluate(goal, moved, at_a);
      moved[j] = point[j] + b;
      evaluate(goal, moved, at_b);
      moved[j] = point[j];
      for (std::size_t i = 0; i < values.size(); ++i)
        gradients[i * point.size() + j] = slope(values[i], a, at_a[i], b, at_b[i]);
    }
  };
}

DesignResponses DesignProblem::responses_with(const DesignParameter& parameter, double value) const {
  CoupledModel model = model_;
  set_value(model, parameter, value);
  return design_responses(simulate(model));
}

ResponseSlopes DesignProblem::slopes(const DesignParameter& parameter) const {
  const double value = value_of(model_, parameter);
  double step = kFirstStep * std::max(std::fabs(value), kLeastScale * (parameter.upper - parameter.lower));
  const Sides sides = sides_for(parameter, value, step);
  const bool central = sides.above != 0.0 && sides.below != 0.0;
  std::vector<DifferenceTable> tables(kDesignResponses.size(),
                                      central ? DifferenceTable(4.0, 4.0) : DifferenceTable(2.0, 2.0));
  ResponseSlopes out{};
  for (std::size_t halving = 0; halving < kHalvings; ++halving, step /= 2.0) {
    const double high = value + sides.above * step, low = value + sides.below * step;
    const DesignResponses above = responses_with(parameter, high), below = responses_with(parameter, low);
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const auto member = kDesignResponses[i].member;
      tables[i].add((above.*member - below.*member) / (high - low));
      out.error[i] = kAccuracy * std::fabs(above.*member) / (high - low);
    }
  }
  for (std::size_t i = 0; i < tables.size(); ++i) {
    out.value[i] = tables[i].value();
    out.error[i] = std::max(tables[i].error(), out.error[i]);
  }
  return out;
}

}  // namespace crashsim
