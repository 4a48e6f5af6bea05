#include <crashsim/uncertainty.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <crashsim/distribution.hpp>
#include <crashsim/option_values.hpp>

#include "bands.hpp"
#include "optimize/fisher_spectrum.hpp"
#include "optimize/fit_errors.hpp"
#include "optimize/profile.hpp"
#include "optimize/replicates.hpp"
#include "parallel.hpp"
#include "uncertainty_words.hpp"

namespace crashsim {
namespace {

using Eigen::Index;

constexpr std::size_t kBandPoints = 101;  // of a curve

/// What everything is made from.
struct Study {
  const UncertaintyOptions& options;
  FitStudy fit;
  CrushModel model;
  LinearFit linear;
  Eigen::MatrixXd covariance;
};

void check(const FitStudy& study, std::span<const Pulse> pulses, const Identification& fit) {
  if (!fit.usable())
    throw InvalidInput(fmt::format("uncertainty: the identification is not usable ({}): there is nothing to judge",
                                   name_of(fit.outcome)));
  if (fit.ordinates.size() != study.structure.size() || fit.tests.size() != pulses.size() ||
      fit.model.law != study.structure.law)
    throw InvalidInput(
        fmt::format("uncertainty: the identification's {} ordinates are not those of these {} pulses and options: give "
                    "what identify() was given",
                    fit.ordinates.size(), pulses.size()));
}

Study study_of(std::span<const Pulse> pulses, const IdentifyOptions& how, const Identification& fit,
               const UncertaintyOptions& options, Uncertainty& out) {
  Study study{options, FitStudy(pulses, how), fit.model, {}, {}};
  check(study.fit, pulses, fit);
  for (const OrdinateReport& ordinate : fit.ordinates) {
    OrdinateUncertainty& told = out.ordinates.emplace_back();
    told.name = ordinate.name;
    told.value = ordinate.value;
    told.state = state_of(ordinate, fit.smooth);
  }
  study.linear = linear_fit_of(pulses, fit, study.fit);
  study.covariance = covariance_of(study.linear);
  return study;
}

std::vector<std::string> names_of(const Uncertainty& out) {
  std::vector<std::string> names;
  for (const OrdinateUncertainty& ordinate : out.ordinates) names.push_back(ordinate.name);
  return names;
}

std::vector<std::vector<double>> rows_of(const Eigen::MatrixXd& matrix) {
  std::vector<std::vector<double>> rows;
  for (Index i = 0; i < matrix.rows(); ++i) rows.emplace_back(matrix.row(i).begin(), matrix.row(i).end());
  return rows;
}

/// Errors, correlations and spectrum.
void tell_errors(const Study& study, double error, Uncertainty& out) {
  const double z = normal_quantile(0.5 + 0.5 * study.options.level);
  out.covariance = rows_of(study.covariance);
  out.correlation = rows_of(correlation_of(study.covariance));
  for (std::size_t i = 0; i < out.ordinates.size(); ++i) {
    OrdinateUncertainty& ordinate = out.ordinates[i];
    if (ordinate.state != OrdinateState::free) continue;
    const auto at = static_cast<Index>(i);
    ordinate.standard_error = std::sqrt(study.covariance(at, at));
    if (std::isnan(ordinate.standard_error)) {
      ordinate.state = OrdinateState::undetermined;
      continue;
    }
    const double theta = study.linear.theta[at], lowest = ordinate.value - theta;
    ordinate.low = lowest + std::max(0.0, theta - z * ordinate.standard_error);
    ordinate.high = lowest + std::min(study.fit.upper[at], theta + z * ordinate.standard_error);
  }
  out.spectrum = fisher_spectrum(study.linear, study.covariance, names_of(out), error);
  out.combinations = determined_sums(study.linear, study.covariance, names_of(out));
}

void tell_noise(const Study& study, Uncertainty& out) {
  for (std::size_t t = 0; t < study.linear.noise.size(); ++t) {
    const FitTarget& target = study.fit.targets[t];
    const NoiseProcess& noise = study.linear.noise[t];
    const double step = target.time_s.back() / static_cast<double>(target.time_s.size() - 1);
    out.noise_mps2.push_back(noise.deviation());
    out.correlation_time_s.push_back(step * static_cast<double>(correlation_lag(study.linear.residual[t])));
  }
}

/// Jobs on all threads with one count of what is done; false of `go_on` when they are to end.
class Work {
 public:
  Work(int jobs, int total, const Progress& progress) : jobs_(jobs), total_(total), progress_(progress) {}

  /// @returns whether all were done.
  bool run(int count, const std::function<void(int index)>& job) {
    const int done = parallel_for(
        count, std::min(thread_count(jobs_), std::max(1, count)), [&](int, int index) { job(index); },
        [&](int so_far, int) {
          if (progress_ && !progress_(before_ + so_far, total_)) stop_ = true;
          return !stop_;
        });
    before_ += done;
    return done == count && !stop_;
  }
  [[nodiscard]] std::function<bool()> go_on() const {
    return [this] { return !stop_; };
  }

 private:
  int jobs_, total_;
  const Progress& progress_;
  int before_ = 0;
  std::atomic<bool> stop_{false};
};

/// Parameters of every replicate, none of those that failed. Empty when they were stopped.
std::vector<std::vector<double>> draw_replicates(const Study& study, Work& work) {
  const UncertaintyOptions& options = study.options;
  std::vector<std::vector<double>> drawn(static_cast<std::size_t>(options.replicates));
  std::function<void(int)> draw;
  const LinearReplicates linear(study.linear, study.fit.upper);
  std::vector<FittedMotion> motions;
  const std::span theta(study.linear.theta.data(), static_cast<std::size_t>(study.linear.theta.size()));
  if (options.resample == Resample::linearised) {
    draw = [&](int i) { drawn[static_cast<std::size_t>(i)] = linear.draw(options.seed, i); };
  } else {
    for (const FitTarget& target : study.fit.targets)
      motions.push_back(fitted_motion(study.fit.structure, theta, target));
    const Renewal renewal{options.resample == Resample::block, options.block};
    draw = [&, renewal](int i) {
      const std::vector<FitTarget> tests = renewed_tests(study.fit, study.linear, motions, renewal, options.seed, i);
      drawn[static_cast<std::size_t>(i)] = fit_again(study.fit, tests, study.linear.theta, work.go_on());
    };
  }
  if (!work.run(options.replicates, draw)) drawn.clear();
  return drawn;
}

void set_row(const std::vector<double>& numbers, Index row, RowMatrix& rows) {
  if (rows.rows() > 0) std::copy(numbers.begin(), numbers.end(), rows.row(row).begin());
}

/// Replicates as models. What a fit varies has an array here.
CrushModels models_of(const Study& study, const std::vector<std::vector<double>>& drawn) {
  CrushModels models;
  models.common = study.model;
  const auto rows = std::count_if(drawn.begin(), drawn.end(), [](const auto& row) { return !row.empty(); });
  if (rows == 0) return models;
  const auto columns = [](const PiecewiseLinear& curve) { return static_cast<Index>(curve.knots.size()); };
  if (columns(study.model.spring) > 0) models.spring_ordinates.resize(rows, columns(study.model.spring));
  if (columns(study.model.damper) > 0) models.damper_ordinates.resize(rows, columns(study.model.damper));
  if (study.fit.structure.free_springs() > 0) models.spring_knots.resize(rows, columns(study.model.spring));
  if (study.fit.structure.free_dampers() > 0) models.damper_knots.resize(rows, columns(study.model.damper));
  Index row = 0;
  for (const std::vector<double>& parameters : drawn) {
    if (parameters.empty()) continue;
    const CrushModel model = make_model(study.fit.structure, parameters, study.model.mass_kg, kUnset);
    set_row(model.spring.ordinates, row, models.spring_ordinates);
    set_row(model.damper.ordinates, row, models.damper_ordinates);
    set_row(model.spring.knots, row, models.spring_knots);
    set_row(model.damper.knots, row, models.damper_knots);
    if (study.fit.structure.has_rate()) models.rate_coefficient.push_back(model.rate_coefficient);
    ++row;
  }
  return models;
}

/// Band of what `value` makes of each model at each point.
template <class Value>
Band band_over(std::vector<double> at, const Study& study, const CrushModels& replicates, const Value& value) {
  Band band{std::move(at), {}, {}, {}};
  const std::size_t rows = replicate_count(replicates);
  RowMatrix values(static_cast<Index>(rows), static_cast<Index>(band.at.size()));
  for (std::size_t i = 0; i < band.at.size(); ++i) band.value.push_back(value(study.model, i));
  for (std::size_t row = 0; row < rows; ++row) {
    const CrushModel model = replicates.model(row);
    for (std::size_t i = 0; i < band.at.size(); ++i)
      values(static_cast<Index>(row), static_cast<Index>(i)) = value(model, i);
  }
  band_of(values, study.options.level, band.low, band.high);
  return band;
}

Band curve_band(const Study& study, const CrushModels& replicates, PiecewiseLinear CrushModel::*curve, double last) {
  const PiecewiseLinear& own = study.model.*curve;
  if (own.knots.empty()) return {};
  const std::vector<double> at =
      uniform_knots(own.knots.size() > 1 ? own.knots.back() : last, static_cast<int>(kBandPoints));
  return band_over(at, study, replicates,
                   [&](const CrushModel& model, std::size_t i) { return evaluate(model.*curve, at[i]); });
}

Band force_band(const Study& study, const CrushModels& replicates, const FitTarget& target) {
  const std::span theta(study.linear.theta.data(), static_cast<std::size_t>(study.linear.theta.size()));
  const FittedMotion motion = fitted_motion(study.fit.structure, theta, target);
  std::vector<double> x, v;
  const std::size_t last = target.time_s.size() - 1, points = std::min(kBandPoints, last + 1);
  for (std::size_t i = 0; i < points; ++i) {
    x.push_back(std::max(0.0, motion.displacement_m[i * last / (points - 1)]));
    v.push_back(motion.velocity_mps[i * last / (points - 1)]);
  }
  return band_over(x, study, replicates, [&](const CrushModel& model, std::size_t i) {
    return spring_force(model, x[i]) + damper_force(model, x[i], v[i]);
  });
}

/// Bands, and intervals of what has no standard error.
void tell_bands(const Study& study, Uncertainty& out) {
  double crush = 0.0, speed = 0.0;
  for (const FitTarget& target : study.fit.targets) {
    crush = std::max(crush, target.max_crush_m);
    speed = std::max(speed, target.impact_speed_mps);
  }
  out.spring = curve_band(study, out.replicates, &CrushModel::spring, crush);
  const double end = study.model.law == CrushLaw::crush_damping ? crush : speed;
  out.damper = curve_band(study, out.replicates, &CrushModel::damper, end);
  for (const FitTarget& target : study.fit.targets) out.force.push_back(force_band(study, out.replicates, target));
}

void tell_held_intervals(const std::vector<std::vector<double>>& drawn, const Eigen::VectorXd& theta, double level,
                         Uncertainty& out) {
  std::vector<double> values;
  for (std::size_t i = 0; i < out.ordinates.size(); ++i) {
    if (out.ordinates[i].state == OrdinateState::free) continue;
    values.clear();
    for (const std::vector<double>& row : drawn)
      if (!row.empty()) values.push_back(row[i]);
    const auto [low, high] = interval_of(values, level);
    const double lowest = out.ordinates[i].value - theta[static_cast<Index>(i)];
    out.ordinates[i].low = lowest + low;
    out.ordinates[i].high = lowest + high;
  }
}

bool tell_profiles(const Study& study, Work& work, Uncertainty& out) {
  const Eigen::VectorXd curvature = inverse_curvature(study.linear);
  const double z = normal_quantile(0.5 + 0.5 * study.options.level);
  return work.run(static_cast<int>(out.ordinates.size()), [&](int index) {
    OrdinateUncertainty& ordinate = out.ordinates[static_cast<std::size_t>(index)];
    if (ordinate.state != OrdinateState::free) return;
    const double scale = curvature[index] / study.covariance(index, index);
    Profile profile = profile_of(study.fit, study.linear, static_cast<std::size_t>(index), scale,
                                 ordinate.standard_error, z * z, work.go_on());
    const double lowest = ordinate.value - study.linear.theta[index];
    for (double& at : profile.at) at += lowest;
    ordinate.profile_low = lowest + profile.low;
    ordinate.profile_high = lowest + profile.high;
    ordinate.profile_low_open = profile.low_open;
    ordinate.profile_high_open = profile.high_open;
    ordinate.profile_at = std::move(profile.at);
    ordinate.profile_rise = std::move(profile.rise);
  });
}

}  // namespace

std::size_t replicate_count(const CrushModels& replicates) {
  return static_cast<std::size_t>(std::max(replicates.spring_ordinates.rows(), replicates.damper_ordinates.rows()));
}

Uncertainty uncertainty(std::span<const Pulse> pulses, const IdentifyOptions& how, const Identification& fit,
                        const UncertaintyOptions& options, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  validate_options(options, "UncertaintyOptions");
  Uncertainty out;
  out.resample = options.resample;
  out.level = options.level;
  const Study study = study_of(pulses, how, fit, options, out);
  tell_errors(study, fit.error.total, out);
  tell_noise(study, out);
  Work work(options.jobs, options.replicates + (options.profile ? static_cast<int>(out.ordinates.size()) : 0),
            progress);
  const std::vector<std::vector<double>> drawn = draw_replicates(study, work);
  out.replicates = models_of(study, drawn);
  out.failed_replicates = static_cast<int>(drawn.size() - replicate_count(out.replicates));
  const bool is_done = drawn.size() == static_cast<std::size_t>(options.replicates) &&
                       (!options.profile || tell_profiles(study, work, out));
  if (replicate_count(out.replicates) > 0) {
    tell_held_intervals(drawn, study.linear.theta, options.level, out);
    tell_bands(study, out);
  }
  out.outcome = is_done ? UncertaintyOutcome::completed : UncertaintyOutcome::interrupted;
  out.message = is_done ? words_of(out) : "stopped before all replicates and profiles were made";
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

std::string Uncertainty::brief_report() const { return outcome == UncertaintyOutcome::not_run ? "not run" : message; }

}  // namespace crashsim
