#include "optimize/fit_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "optimize/effective_samples.hpp"
#include "optimize/smoothing_choice.hpp"

namespace crashsim {
namespace {

constexpr double kBoundFactor = 2.0;   // spring or damper alone may carry this much of the measured force
constexpr double kLeastGap = 0.1;      // between quantile knots, relative to even spacing
constexpr double kLeastFactor = 0.25;  // of its range that what multiplies an ordinate has at a sample that bounds it
constexpr double kRateFactor = 2.0;    // by which law `rate` may add to the spring's force

/// Knots at quantiles of the samples, moved apart where samples crowd: kLeastGap of the even spacing is kept.
std::vector<double> quantile_knots(std::vector<double> samples, double last, int count) {
  std::sort(samples.begin(), samples.end());
  std::vector<double> knots = uniform_knots(last, count);
  const double gap = count > 1 ? kLeastGap * knots[1] : 0.0;
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
    const double position =
        static_cast<double>(i) / static_cast<double>(knots.size() - 1) * static_cast<double>(samples.size() - 1);
    knots[i] = std::max(samples[static_cast<std::size_t>(position)], knots[i - 1] + gap);
  }
  for (std::size_t i = knots.size(); i-- > 2;) knots[i - 1] = std::min(knots[i - 1], knots[i] - gap);
  return knots;
}

void check_given_knots(const std::vector<double>& knots) {
  if (knots.empty())
    throw InvalidInput("IdentifyOptions.knots: no numbers given: give the spring's knots in m, from 0");
  for (std::size_t i = 0; i < knots.size(); ++i)
    if (i == 0 ? knots[i] != 0.0 : knots[i] <= knots[i - 1])
      throw InvalidInput(
          fmt::format("IdentifyOptions.knots[{}] = {} m: knots must start at 0 and increase strictly", i, knots[i]));
}

/// Largest crush and speed, and all samples of both.
struct Ranges {
  double crush = 0.0, speed = 0.0;
  std::vector<double> x, v;

  explicit Ranges(std::span<const FitTarget> targets) {
    for (const FitTarget& target : targets) {
      crush = std::max(crush, target.max_crush_m);
      speed = std::max(speed, target.impact_speed_mps);
      x.insert(x.end(), target.displacement_m.begin(), target.displacement_m.end());
      v.insert(v.end(), target.velocity_mps.begin(), target.velocity_mps.end());
    }
  }
};

/// @param of_crush the variable is crush, not speed.
std::vector<double> place_knots(const IdentifyOptions& options, const Ranges& ranges, bool of_crush, int count) {
  const double last = of_crush ? ranges.crush : ranges.speed;
  switch (options.knots.rule) {
    case KnotPlacement::uniform:
    case KnotPlacement::free:
      return uniform_knots(last, count);
    case KnotPlacement::quantile:
      return quantile_knots(of_crush ? ranges.x : ranges.v, last, count);
    case KnotPlacement::given:
      break;
  }
  std::vector<double> knots = options.knots.numbers;
  check_given_knots(knots);
  if (count == 0) return {};
  if (of_crush) return knots;
  const double end = knots.back();
  for (double& knot : knots) knot = knots.size() > 1 ? knot / end * last : 0.0;
  return knots;
}

FitStructure make_structure(const IdentifyOptions& options, std::span<const FitTarget> targets) {
  const Ranges ranges(targets);
  FitStructure structure{options.law, {}, {}};
  structure.spring_knots = place_knots(options, ranges, true, options.spring_knots);
  if (options.law != CrushLaw::rate)
    structure.damper_knots = place_knots(options, ranges, options.law == CrushLaw::crush_damping, options.damper_knots);
  structure.curve = options.curve;
  structure.has_free_knots = options.knots.rule == KnotPlacement::free;
  structure.reference_speed_mps = options.reference_speed_mps;
  if (structure.ordinates() == 0)
    throw InvalidInput(options.law == CrushLaw::rate
                           ? "IdentifyOptions.spring_knots = 0: law rate has nothing but its spring to identify"
                           : "IdentifyOptions.spring_knots = 0 and damper_knots = 0: there is nothing to identify");
  if (structure.has_free_knots && structure.curve == Curve::pchip)
    throw InvalidInput("IdentifyOptions.knots = free: goes with curve = linear, this is pchip: choose one of them");
  return structure;
}

/// What a hat alone needs at a sample to carry kBoundFactor times the measured force, NaN where that says nothing:
/// what multiplies the ordinate must be at least a quarter of its range.
double least_ordinate(double force, double factor, double least_factor) {
  return factor > least_factor ? kBoundFactor * force / factor : kUnset;
}

/// Upper bounds of one curve over its variable, from the samples where each hat stands.
/// @param factor what multiplies an ordinate, and how large it must be, at sample j of a target.
template <class Factor>
void bound_curve(const std::vector<double>& knots, std::span<const FitTarget> targets,
                 std::vector<double> FitTarget::*variable, const Factor& factor, double fallback,
                 Eigen::Ref<Eigen::VectorXd> upper) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const double low = i > 0 ? knots[i - 1] : 0.0;
    const double high = i + 1 < knots.size() ? knots[i + 1] : std::numeric_limits<double>::infinity();
    double bound = 0.0;
    for (const FitTarget& target : targets)
      for (std::size_t j = 0; j < target.time_s.size(); ++j) {
        const double s = (target.*variable)[j];
        if (s < low || s > high) continue;
        const auto [by, least] = factor(target, j);
        bound = std::fmax(bound, least_ordinate(target.mass_kg * std::fabs(target.accel_mps2[j]), by, least));
      }
    upper[static_cast<Eigen::Index>(i)] = bound > 0.0 ? bound : kBoundFactor * fallback;
  }
}

struct Factor {
  double value, least;
};

/// Of curves that multiply their own variable: a quarter of the first segment, or of all there is of a single knot.
auto own_variable(const std::vector<double>& knots, std::span<const FitTarget> targets,
                  std::vector<double> FitTarget::*variable) {
  double range = knots.size() > 1 ? knots[1] : 0.0;
  if (knots.size() == 1)
    for (const FitTarget& target : targets)
      for (const double s : target.*variable) range = std::max(range, s);
  return [variable, least = kLeastFactor * range](const FitTarget& target, std::size_t j) {
    return Factor{(target.*variable)[j], least};
  };
}

void bound_spring(const FitStructure& structure, std::span<const FitTarget> targets, double fallback,
                  Eigen::Ref<Eigen::VectorXd> upper) {
  const auto& knots = structure.spring_knots;
  const auto variable = &FitTarget::displacement_m;
  const auto own = own_variable(knots, targets, variable);
  if (structure.law == CrushLaw::stiffness) return bound_curve(knots, targets, variable, own, fallback, upper);
  const auto force = [&](const FitTarget& target, std::size_t j) {  // near 0 the force may rise steeply
    return own(target, j).value > own(target, j).least ? Factor{1.0, 0.0} : Factor{0.0, 0.0};
  };
  bound_curve(knots, targets, variable, force, fallback, upper);
}

void bound_damper(const FitStructure& structure, std::span<const FitTarget> targets, double fallback,
                  Eigen::Ref<Eigen::VectorXd> upper) {
  const auto& knots = structure.damper_knots;
  if (structure.law != CrushLaw::crush_damping)
    return bound_curve(knots, targets, &FitTarget::velocity_mps, own_variable(knots, targets, &FitTarget::velocity_mps),
                       fallback, upper);
  const auto speed = [](const FitTarget& target, std::size_t j) {
    return Factor{target.velocity_mps[j], kLeastFactor * target.impact_speed_mps};
  };
  bound_curve(knots, targets, &FitTarget::displacement_m, speed, fallback / kLeastFactor, upper);
}

Eigen::VectorXd upper_bounds(const FitStructure& structure, const IdentifyOptions& options,
                             std::span<const FitTarget> targets) {
  const auto springs = static_cast<Eigen::Index>(structure.springs());
  const auto dampers = static_cast<Eigen::Index>(structure.dampers());
  const ForceScale scale = force_scale(structure.law, targets);
  Eigen::VectorXd upper(static_cast<Eigen::Index>(structure.size()));
  bound_spring(structure, targets, scale.spring, upper.head(springs));
  bound_damper(structure, targets, scale.damper, upper.segment(springs, dampers));
  if (!std::isnan(options.spring_upper)) upper.head(springs).setConstant(options.spring_upper);
  if (!std::isnan(options.damper_upper)) upper.segment(springs, dampers).setConstant(options.damper_upper);
  if (structure.has_rate()) {
    const double by_default = kRateFactor / std::log1p(Ranges(targets).speed / structure.reference_speed_mps);
    upper[springs + dampers] = std::isnan(options.rate_upper) ? by_default : options.rate_upper;
  }
  const Eigen::VectorXd ranges = free_knot_ranges(structure);
  upper.tail(ranges.size()) = ranges;
  return upper;
}

/// Weights of the channels of one test of several.
Setting<Weights> weights_of(const IdentifyOptions& options, std::size_t test, std::size_t tests) {
  const std::vector<double>& all = options.weights.numbers;
  if (options.weights.rule != Weights::given || tests == 1 || all.size() != 3 * tests) return options.weights;
  const auto first = all.begin() + 3 * static_cast<std::ptrdiff_t>(test);
  return {Weights::given, {first, first + 3}};
}

/// Weights of the tests with the mean 1.
std::vector<double> test_weights(const IdentifyOptions& options, std::size_t tests) {
  const std::vector<double>& given = options.test_weights;
  if (given.empty()) return std::vector<double>(tests, 1.0);
  const auto is_bad = [](double w) { return !std::isfinite(w) || w <= 0.0; };
  if (given.size() != tests || std::any_of(given.begin(), given.end(), is_bad))
    throw InvalidInput(fmt::format("IdentifyOptions.test_weights = {}: {} numbers > 0 are needed, one a test",
                                   fmt::join(given, ","), tests));
  double sum = 0.0;
  for (const double weight : given) sum += weight;
  std::vector<double> weights;
  for (const double weight : given) weights.push_back(weight * static_cast<double>(tests) / sum);
  return weights;
}

void set_prior(const std::vector<double>& given, std::string_view name, double deviation, Eigen::Index first,
               Eigen::Index count, Prior& prior) {
  if (given.empty()) return;
  const auto is_bad = [](double y) { return !std::isfinite(y) || y < 0.0; };
  const double largest = *std::max_element(given.begin(), given.end());
  if ((given.size() != 1 && static_cast<Eigen::Index>(given.size()) != count) ||
      std::any_of(given.begin(), given.end(), is_bad) || largest == 0.0)
    throw InvalidInput(
        fmt::format("IdentifyOptions.{} = {}: one number for all, or {} numbers, >= 0 and not all 0, are needed", name,
                    fmt::join(given, ","), count));
  for (Eigen::Index i = 0; i < count; ++i) {
    prior.values[first + i] = given[given.size() == 1 ? 0 : static_cast<std::size_t>(i)];
    prior.deviations[first + i] = deviation * largest;
  }
}

Prior make_prior(const FitStructure& structure, const IdentifyOptions& options, double observation_error) {
  if (options.spring_prior.empty() && options.damper_prior.empty()) return {};
  const auto size = static_cast<Eigen::Index>(structure.size());
  const auto springs = static_cast<Eigen::Index>(structure.springs());
  Prior prior{Eigen::VectorXd::Zero(size), Eigen::VectorXd::Constant(size, std::numeric_limits<double>::infinity()),
              observation_error};
  set_prior(options.spring_prior, "spring_prior", options.prior_deviation, 0, springs, prior);
  set_prior(options.damper_prior, "damper_prior", options.prior_deviation, springs,
            static_cast<Eigen::Index>(structure.dampers()), prior);
  return prior;
}

/// Number of independent observations in the forces that a solution of the equation error leaves: those that hang
/// together count as one.
double observations_of(const FitStudy& study, std::span<const double> parameters) {
  const ForceResiduals force = force_residuals(study.structure, study.targets, parameters);
  double observations = 0.0;
  Eigen::Index first = 0;
  for (const FitTarget& target : study.targets) {
    const auto count = static_cast<Eigen::Index>(target.time_s.size());
    const Eigen::VectorXd residuals = force.residuals.segment(first, count);
    observations += effective_samples({residuals.data(), target.time_s.size()});
    first += count;
  }
  return observations;
}

std::span<const double> view(const Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

/// E at the equation-error solution over the number of independent observations.
double error_of_observation(const FitStudy& study) {
  const Eigen::VectorXd linear = study.solve_equation_error();
  const double error = study.objective().evaluate(view(linear), 0.0, {});
  return std::isfinite(error) ? error / observations_of(study, view(linear)) : 0.0;
}

/// Weight of the smoothing that the equation error asks for, in proportion to the loss of the fit.
double chosen_smoothing(const FitStudy& study) {
  const EquationErrorSystem system = assemble_equation_error(study.structure, study.targets, study.upper);
  const Eigen::VectorXd linear = study.solve_equation_error();
  const double inflation = static_cast<double>(system.rhs.size()) / observations_of(study, view(linear));
  const double smooth = choose_smoothing(system, study.upper, study.options.smoothing, inflation).smooth;
  if (study.options.loss == Loss::l2 || study.options.method == IdentifyMethod::equation_error) return smooth;
  FitObjective squared(study.structure, study.targets, Loss::l2, 0.0);
  const double ratio = study.objective().evaluate(view(linear), 0.0, {}) / squared.evaluate(view(linear), 0.0, {});
  return std::isfinite(ratio) ? smooth * ratio : smooth;
}

bool needs_observation_error(const IdentifyOptions& options) {
  return !options.spring_prior.empty() || !options.damper_prior.empty() || options.time_shift_deviation_s > 0.0 ||
         options.gain_deviation > 0.0 || options.bias_deviation_mps2 > 0.0;
}

}  // namespace

FitStudy::FitStudy(std::span<const Pulse> pulses, const IdentifyOptions& how) : options(how) {
  const std::vector<double> weights = test_weights(how, pulses.size());
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    targets.push_back(make_target(pulses[i], how.mass_kg, weights_of(how, i, pulses.size())));
    targets.back().factor *= weights[i];
  }
  structure = make_structure(how, targets);
  upper = upper_bounds(structure, how, targets);
  if (how.smoothing != Smoothing::fixed && how.smooth > 0.0)
    throw InvalidInput(fmt::format("IdentifyOptions.smooth = {}: goes with smoothing = fixed, this is {}: choose one",
                                   how.smooth, name_of(how.smoothing)));
  smooth = how.smoothing == Smoothing::fixed ? how.smooth : chosen_smoothing(*this);
  if (needs_observation_error(how)) observation_error = error_of_observation(*this);
  prior = make_prior(structure, how, observation_error);
}

}  // namespace crashsim
