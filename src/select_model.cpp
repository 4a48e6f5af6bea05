#include <crashsim/select_model.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>
#include <crashsim/simulate.hpp>

#include "optimize/fit_target.hpp"
#include "parallel.hpp"
#include "select_candidates.hpp"

namespace crashsim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLongestWait = 4.0;  // t_m measured: a model that still moves then has none
constexpr double kShortestEnd_s = 0.3;
constexpr double kRtol = 1e-10;

/// Identifies; input that this candidate alone cannot use becomes its outcome.
Identification fit(std::span<const Pulse> pulses, const SelectionRow& row, const SelectOptions& options,
                   const Progress& progress) {
  try {
    return identify(pulses, identify_options_of(row, options), progress);
  } catch (const InvalidInput& problem) {
    Identification none;
    none.outcome = IdentifyOutcome::every_start_failed;
    none.message = problem.what();
    return none;
  } catch (const NumericalFailure& problem) {
    Identification none;
    none.outcome = IdentifyOutcome::every_start_failed;
    none.message = problem.what();
    return none;
  }
}

void take_fit(const Identification& found, SelectionRow& row) {
  row.outcome = found.outcome;
  row.message = found.message;
  if (!found.usable()) return;
  row.model = found.model;
  row.error = found.error;
  row.identifiable = found.verdict.identifiable;
  row.parameters = static_cast<int>(
      std::count_if(found.ordinates.begin(), found.ordinates.end(),
                    [](const OrdinateReport& ordinate) { return !ordinate.at_bound && !ordinate.untouched; }));
}

/// What a model says of a test.
LeftOutTest predict_test(const CrushModel& fitted, const Pulse& pulse, const SelectOptions& options) {
  LeftOutTest out;
  out.impact_speed_mps = pulse.impact_speed_mps;
  CrushModel model = fitted;
  model.mass_kg = std::isnan(options.mass_kg) ? pulse.mass_kg : options.mass_kg;
  SimulateOptions how;
  how.impact_speed_mps = pulse.impact_speed_mps;
  how.to_max_crush = true;
  how.end_time_s = std::max(kShortestEnd_s, kLongestWait * pulse.t_m_s);
  how.rtol = kRtol;
  how.integrator = Integrator::taylor;  // CVODE's noise makes a v that only decays cross 0 in the end
  const CrushResponse run = simulate(model, how);
  if (!run.usable() && run.outcome != CrushOutcome::no_max_crush) return out;
  try {
    out.error = fit_error(model, pulse, options.weights, options.loss).total;
  } catch (const NumericalFailure&) {
    return out;
  }
  out.predicted = true;
  out.t_m_s = run.usable() ? run.t_m_s : kInfinity;
  out.t_m_error = out.t_m_s / pulse.t_m_s - 1.0;
  if (!run.usable()) return out;
  out.max_crush_m = run.max_crush_m;
  out.max_crush_error = out.max_crush_m / pulse.max_crush_m - 1.0;
  return out;
}

std::vector<Pulse> without(std::span<const Pulse> pulses, std::size_t left_out) {
  std::vector<Pulse> others(pulses.begin(), pulses.end());
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
  return others;
}

/// Job j fits candidate j / (1 + tests left out): to all tests, then without each.
class Jobs {
 public:
  Jobs(std::span<const Pulse> pulses, const SelectOptions& options, std::vector<SelectionRow>& rows)
      : pulses_(pulses),
        options_(options),
        rows_(rows),
        per_row_(1 + (pulses.size() > 1 ? pulses.size() : 0)),
        finished_(rows.size() * per_row_, 0) {
    for (SelectionRow& row : rows_) {
      row.left_out.resize(per_row_ - 1);
      for (std::size_t i = 0; i < row.left_out.size(); ++i)
        row.left_out[i].impact_speed_mps = pulses[i].impact_speed_mps;
    }
    for (std::size_t i = 0; i + 1 < per_row_; ++i) others_.push_back(without(pulses, i));
  }

  [[nodiscard]] int count() const { return static_cast<int>(finished_.size()); }

  /// `stop` is asked during the fit; a fit that was stopped counts as not done.
  void run(int job, const Progress& stop) {
    const auto index = static_cast<std::size_t>(job);
    SelectionRow& row = rows_[index / per_row_];
    const std::size_t part = index % per_row_;
    if (part == 0) {
      const Identification found = fit(pulses_, row, options_, stop);
      if (found.outcome == IdentifyOutcome::interrupted) return;
      take_fit(found, row);
    } else {
      const Identification found = fit(others_[part - 1], row, options_, stop);
      if (found.outcome == IdentifyOutcome::interrupted) return;
      if (found.usable()) row.left_out[part - 1] = predict_test(found.model, pulses_[part - 1], options_);
    }
    finished_[index] = 1;
  }

  /// Keeps the rows whose fits are all done. @returns whether these are all rows.
  bool keep_finished() {
    std::vector<SelectionRow> kept;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const auto first = finished_.begin() + static_cast<std::ptrdiff_t>(r * per_row_);
      if (std::all_of(first, first + static_cast<std::ptrdiff_t>(per_row_), [](char done) { return done != 0; }))
        kept.push_back(std::move(rows_[r]));
    }
    const bool all = kept.size() == rows_.size();
    rows_ = std::move(kept);
    return all;
  }

 private:
  std::span<const Pulse> pulses_;
  const SelectOptions& options_;
  std::vector<SelectionRow>& rows_;
  std::size_t per_row_;
  std::vector<char> finished_;  // not bool: threads write neighbours
  std::vector<std::vector<Pulse>> others_;
};

/// @returns whether nothing stopped it.
bool fit_all(std::span<const Pulse> pulses, const SelectOptions& options, const Progress& progress,
             std::vector<SelectionRow>& rows) {
  Jobs jobs(pulses, options, rows);
  std::atomic<bool> stopped{false};
  const Progress go_on = [&stopped](int, int) { return !stopped; };
  parallel_for(
      jobs.count(), thread_count(options.jobs), [&](int, int job) { jobs.run(job, go_on); },
      [&](int done, int count) {
        if (progress && !progress(done, count)) stopped = true;
        return !stopped;
      });
  return jobs.keep_finished();
}

}  // namespace

bool LeftOutTest::failed() const { return !predicted || !std::isfinite(t_m_error); }

double LeftOutTest::score() const {
  return failed() ? kInfinity : error + std::fabs(max_crush_error) + std::fabs(t_m_error);
}

Selection select_model(std::span<const Pulse> pulses, const SelectOptions& options, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  validate_options(options, "SelectOptions");
  if (pulses.empty()) throw InvalidInput("select_model: no pulse given");
  Selection out;
  out.tests = static_cast<int>(pulses.size());
  out.rows = candidates_of(options);
  for (const Pulse& pulse : pulses) {
    if (!pulse.time_s.empty() && std::isnan(pulse.t_m_s)) {
      out.outcome = SelectOutcome::no_max_crush;
      out.message = no_max_crush_message(pulse);
      out.rows.clear();
      return out;
    }
    make_target(pulse, options.mass_kg, options.weights);  // refuses what no candidate could use
  }
  const bool all_done = fit_all(pulses, options, progress, out.rows);
  judge_candidates(pulses, options, out);
  if (!all_done) {
    out.outcome = SelectOutcome::interrupted;
    out.message = "stopped before every candidate was fitted: nothing is recommended";
    out.recommendation.clear();
    for (SelectionRow& row : out.rows) row.recommended = false;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

std::string Selection::brief_report() const {
  if (outcome == SelectOutcome::not_run) return "not run";
  return usable() ? recommendation : fmt::format("{}: {}", name_of(outcome), message);
}

const SelectionRow* Selection::recommended() const {
  const auto found = std::find_if(rows.begin(), rows.end(), [](const SelectionRow& row) { return row.recommended; });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace crashsim
