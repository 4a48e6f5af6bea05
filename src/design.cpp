#include <crashsim/design.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/metrics.hpp>
#include <crashsim/option_values.hpp>

#include "optimize/design_problem.hpp"
#include "optimize/starts.hpp"
#include "parallel.hpp"
#include "random.hpp"

namespace crashsim {
namespace {

constexpr double kConverged = 1e-9;      // relative change of the quantity minimised
constexpr int kMostSteps = 100;          // of SLSQP, each with a gradient
constexpr double kPolished = 1e-6;       // the same where COBYLA stops
constexpr int kMostPolish = 300;         // of COBYLA
constexpr double kPolishStep = 0.05;     // of the box: COBYLA's first step near an optimum
constexpr double kFarStep = 0.1;         // and where none is near
constexpr int kMostRounds = 3;           // of COBYLA
constexpr double kWorthwhile = 1e-6;     // relative gain for which another round is run
constexpr double kBest = 1e-3;           // starts this near are at the best
constexpr double kOnLimit = 1e-4;        // relative: the optimum lies on a limit
constexpr double kAtBound = 1e-6;        // of the range
constexpr double kSmallPitch = 1e-3;     // [rad]
constexpr double kDoubtfulSlope = 1e-2;  // of a derivative: its error
constexpr double kNegligible = 1e-4;     // % per %: a derivative that does not matter

/// The search of one optimum.
struct Search {
  ConstrainedMinimum best;
  int starts = 0, at_best = 0;
};

class Study {
 public:
  Study(const CoupledModel& model, const DesignOptions& options, const CoupledOptions& simulation,
        const Progress& progress, DesignResult& out)
      : options_(options),
        problem_(model, simulation, design_parameters(model, options)),
        limits_(limits_of(options)),
        curve_(trade_off_limits(options)),
        progress_(progress),
        out_(out) {
    total_ = options.minimise == DesignQuantity::none ? 0 : options.starts;
    total_ += static_cast<int>(curve_.size()) * (options.starts + 1);
    for (const DesignParameter& p : problem_.parameters()) {
      const double given = value_of(model, p);
      out.variables.push_back({p.name, p.unit, p.lower, p.upper, given});
      if (given < p.lower || given > p.upper)
        out.warnings.push_back(fmt::format("{} = {:.6g} {} of the given model is outside its range {:.6g} to {:.6g}",
                                           p.name, given, p.unit, p.lower, p.upper));
    }
    for (const QuantityLimit& limit : limits_) out.limits.push_back({limit.quantity, limit.value});
    out.minimised = options.minimise;
    out.traded = options.trade_off;
    out.optimum = model;
  }

  void run() {
    const CoupledResponse given = problem_.simulate(out_.optimum);
    out_.before = design_responses(given);
    for (DesignLimit& limit : out_.limits) limit.before = quantity_of(out_.before, limit.quantity);
    if (!given.usable()) {
      out_.outcome = DesignOutcome::model_failed;
      out_.message = fmt::format("{}: {}", name_of(given.outcome), given.message);
    } else {
      const double end_s = given.time_s.back();
      if (given.heave_min_time_s == end_s || given.pitch_max_time_s == end_s)
        out_.warnings.push_back(fmt::format(
            "the motion ends at {:g} s while the body still drops or pitches: a later end gives more of both", end_s));
      take_sensitivities();
      if (options_.minimise != DesignQuantity::none) optimise();
      if (out_.outcome == DesignOutcome::not_run) out_.outcome = DesignOutcome::completed;
    }
    out_.simulations = problem_.simulations();
  }

 private:
  void take_sensitivities();
  void optimise();
  void take_optimum(const ConstrainedMinimum& best);
  void take_trade_off(const ConstrainedMinimum& best, double scale);
  [[nodiscard]] Search search(const DesignGoal& goal, const std::vector<std::vector<double>>& starts);
  static void refine(const ConstrainedFunction& function, std::size_t limits, ConstrainedMinimum& best);
  [[nodiscard]] std::vector<std::vector<double>> start_points() const;
  [[nodiscard]] std::string why_infeasible(const DesignGoal& goal) const;

  const DesignOptions& options_;
  DesignProblem problem_;
  std::vector<QuantityLimit> limits_;
  std::vector<double> curve_;
  const Progress& progress_;
  DesignResult& out_;
  int done_ = 0, total_ = 0;
};

void Study::take_sensitivities() {
  const auto& parameters = problem_.parameters();
  std::vector<ResponseSlopes> slopes(parameters.size());
  parallel_for(
      static_cast<int>(parameters.size()), thread_count(options_.jobs),
      [&](int, int index) {
        const auto i = static_cast<std::size_t>(index);
        slopes[i] = problem_.slopes(parameters[i]);
      },
      [](int, int) { return true; });
  for (std::size_t i = 0; i < parameters.size(); ++i)
    for (std::size_t r = 0; r < kDesignResponses.size(); ++r) {
      const double response = out_.before.*kDesignResponses[r].member, value = out_.variables[i].before;
      DesignSensitivity s{parameters[i].name, std::string(kDesignResponses[r].name), slopes[i].value[r],
                          slopes[i].error[r]};
      if (response != 0.0 && value != 0.0) s.relative = s.derivative * value / response;
      const bool matters = std::isnan(s.relative) || std::fabs(s.relative) > kNegligible;
      if (matters && s.error > kDoubtfulSlope * std::fabs(s.derivative) && s.derivative != 0.0)
        out_.warnings.push_back(
            fmt::format("d {} / d {} = {:.4g} is good to {:.2g} only: the response has a kink nearby", s.response,
                        s.parameter, s.derivative, s.error));
      out_.sensitivities.push_back(std::move(s));
    }
}

std::vector<std::vector<double>> Study::start_points() const {
  std::vector<std::vector<double>> points = {problem_.given_point()};
  for (int start = 1; start < options_.starts; ++start) {
    std::vector<double> point(problem_.parameters().size());
    for (std::size_t i = 0; i < point.size(); ++i)
      point[i] = uniform_random(options_.seed, static_cast<std::uint64_t>(start), i);
    points.push_back(std::move(point));
  }
  return points;
}

/// Without gradients, which a kink makes useless; again from where that stops, as its simplex may have collapsed early.
/// Where the limits are not kept, their largest excess is minimised first.
void Study::refine(const ConstrainedFunction& function, std::size_t limits, ConstrainedMinimum& best) {
  const auto search_from = [&](const ConstrainedFunction& f, std::size_t constraints, double step) {
    return minimize_constrained(ConstrainedAlgorithm::cobyla, f, constraints, best.point, kPolished, kMostPolish, step);
  };
  if (best.violation > 0.0) {
    const ConstrainedFunction excess = [&](std::span<const double> point, std::span<double> value, std::span<double>) {
      std::vector<double> values(1 + limits);
      function(point, values, {});
      value[0] = std::isfinite(values[0]) ? *std::max_element(values.begin() + 1, values.end()) : values[0];
    };
    const ConstrainedMinimum nearest = search_from(excess, 0, kFarStep);
    const ConstrainedMinimum other =
        minimize_constrained(ConstrainedAlgorithm::slsqp, function, limits, nearest.point, kConverged, kMostSteps);
    if (is_better(other, best)) best = other;
  }
  for (int round = 0; round < kMostRounds; ++round) {
    const ConstrainedMinimum other = search_from(function, limits, kPolishStep);
    if (!is_better(other, best)) return;
    const double gain = best.value - other.value;
    best = other;
    if (gain < kWorthwhile * std::fabs(best.value)) return;
  }
}

/// From every start with gradients, then from the best without.
Search Study::search(const DesignGoal& goal, const std::vector<std::vector<double>>& starts) {
  const ConstrainedFunction function = problem_.function(goal);
  const std::size_t limits = goal.limits.size();
  std::vector<ConstrainedMinimum> found(starts.size());
  const int finished = parallel_for(
      static_cast<int>(starts.size()), thread_count(options_.jobs),
      [&](int, int index) {
        const auto i = static_cast<std::size_t>(index);
        found[i] =
            minimize_constrained(ConstrainedAlgorithm::slsqp, function, limits, starts[i], kConverged, kMostSteps);
      },
      [&](int done, int) { return !progress_ || progress_(std::min(done_ + done, total_), total_); });
  done_ += static_cast<int>(starts.size());
  std::erase_if(found, [](const ConstrainedMinimum& minimum) { return minimum.point.empty(); });
  if (finished < static_cast<int>(starts.size())) out_.outcome = DesignOutcome::interrupted;
  if (found.empty()) return {};
  Search out{*std::ranges::min_element(found, is_better), static_cast<int>(found.size())};
  if (out_.outcome != DesignOutcome::interrupted) refine(function, limits, out.best);
  for (const ConstrainedMinimum& minimum : found)
    if (minimum.violation <= 0.0 && minimum.value <= out.best.value + kBest * std::fabs(out.best.value)) ++out.at_best;
  return out;
}

void Study::optimise() {
  const double given = quantity_of(out_.before, options_.minimise);
  const double scale = given > 0.0 ? given : 1.0;
  const DesignGoal goal{options_.minimise, scale, limits_};
  const Search found = search(goal, start_points());
  out_.starts = found.starts;
  out_.starts_at_best = found.at_best;
  const bool was_interrupted = out_.outcome == DesignOutcome::interrupted;
  if (was_interrupted) out_.message = fmt::format("stopped after {} of {} starts", found.starts, options_.starts);
  if (found.best.point.empty() || !std::isfinite(found.best.value)) {
    if (was_interrupted) return;
    out_.outcome = DesignOutcome::infeasible;
    out_.message = "no design in the ranges has a usable motion";
    return;
  }
  take_optimum(found.best);
  if (was_interrupted) return;
  if (found.best.violation > 0.0) {
    out_.outcome = DesignOutcome::infeasible;
    out_.message = why_infeasible(goal);
  }
  take_trade_off(found.best, scale);
}

void Study::take_optimum(const ConstrainedMinimum& best) {
  out_.optimum = problem_.model_at(best.point);
  const CoupledResponse response = problem_.simulate(out_.optimum);
  out_.after = design_responses(response);
  const double nose_up = -std::ranges::min(response.pitch_rad);
  if (nose_up > std::max(response.pitch_max_rad, kSmallPitch))
    out_.warnings.push_back(
        fmt::format("at the optimum the nose comes up by {:.3g} rad: pitch counts nose-down motion only", nose_up));
  for (const std::string& note : response.notes) out_.warnings.push_back("at the optimum " + note);
  for (std::size_t i = 0; i < out_.variables.size(); ++i) {
    DesignVariable& variable = out_.variables[i];
    variable.after = value_of(out_.optimum, problem_.parameters()[i]);
    variable.at_bound = std::min(best.point[i], 1.0 - best.point[i]) < kAtBound;
    if (variable.at_bound)
      out_.warnings.push_back(fmt::format("{} = {:.6g} {} is at its bound: a better design may lie beyond it",
                                          variable.name, variable.after, variable.unit));
  }
  for (DesignLimit& limit : out_.limits) {
    limit.after = quantity_of(out_.after, limit.quantity);
    limit.active = limit.after > (1.0 - kOnLimit) * limit.limit;
  }
}

std::string Study::why_infeasible(const DesignGoal& goal) const {
  std::vector<std::string> exceeded;
  for (const QuantityLimit& limit : goal.limits) {
    const double value = quantity_of(out_.after, limit.quantity);
    const std::string_view unit = unit_of(limit.quantity).empty() ? "g" : unit_of(limit.quantity);
    if (value > limit.value)
      exceeded.push_back(
          fmt::format("{} = {:.5g} {} where {:.5g} is allowed", name_of(limit.quantity), value, unit, limit.value));
  }
  return fmt::format("no design in the ranges keeps all limits; the nearest has {}: widen the ranges or the limits",
                     fmt::join(exceeded, ", "));
}

/// From the tightest limit to the loosest: each optimum is a start of the next, so the curve never rises.
void Study::take_trade_off(const ConstrainedMinimum& best, double scale) {
  std::vector<QuantityLimit> others = limits_;
  std::erase_if(others, [&](const QuantityLimit& limit) { return limit.quantity == options_.trade_off; });
  std::vector<double> last = best.point;
  for (const double limit : curve_) {
    if (out_.outcome == DesignOutcome::interrupted) return;
    DesignGoal goal{options_.minimise, scale, others};
    goal.limits.push_back({options_.trade_off, limit});
    std::vector<std::vector<double>> starts = start_points();
    starts.push_back(last);
    const Search found = search(goal, starts);
    TradeOffPoint point;
    point.limit = limit;
    point.values.assign(out_.variables.size(), kUnset);
    if (!found.best.point.empty() && found.best.violation <= 0.0 && std::isfinite(found.best.value)) {
      const CoupledModel model = problem_.model_at(found.best.point);
      last = found.best.point;
      point.feasible = true;
      point.responses = design_responses(problem_.simulate(model));
      point.objective = quantity_of(point.responses, options_.minimise);
      for (std::size_t i = 0; i < point.values.size(); ++i) point.values[i] = value_of(model, problem_.parameters()[i]);
    }
    out_.trade_off.push_back(std::move(point));
  }
}

std::string shown(DesignQuantity quantity, double value) {
  const std::string_view unit = unit_of(quantity);
  return fmt::format("{} {:.5g} {}", name_of(quantity), value, unit.empty() ? "g" : unit);
}

}  // namespace

DesignResponses design_responses(const CoupledResponse& response) {
  if (!response.usable()) return {};
  const Olc olc = occupant_load_criterion(response.time_s, response.velocity_mps, response.displacement_m);
  return {.pitch_max_rad = response.pitch_max_rad,
          .heave_min_m = response.heave_min_m,
          .max_crush_m = response.max_crush_m,
          .olc_g = olc.olc_g,
          .peak_decel_g = response.peak_decel_g,
          .t_m_s = response.t_m_s};
}

std::string DesignResult::brief_report() const {
  if (outcome == DesignOutcome::not_run) return "not run";
  if (!usable()) return fmt::format("{}: {}", name_of(outcome), message);
  if (minimised == DesignQuantity::none) return "sensitivities only";
  std::vector<std::string> on;
  for (const DesignLimit& limit : limits)
    if (limit.active) on.push_back(shown(limit.quantity, limit.limit));
  return fmt::format("{}, was {:.5g}{}; {} of {} starts at the best, {} simulations",
                     shown(minimised, quantity_of(after, minimised)), quantity_of(before, minimised),
                     on.empty() ? "" : fmt::format("; on the limit {}", fmt::join(on, ", ")), starts_at_best, starts,
                     simulations);
}

DesignResult design(const CoupledModel& model, const DesignOptions& options, const CoupledOptions& simulation,
                    const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  validate_options(options, "DesignOptions");
  const CoupledModel whole = with_one_mass(model);
  validate(whole);
  DesignResult out;
  Study(whole, options, simulation, progress, out).run();
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace crashsim
