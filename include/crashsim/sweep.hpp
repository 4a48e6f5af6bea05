#pragma once
/// Sweeps and Monte Carlo studies: a case at many samples of its numbers.

#include <cstdint>
#include <string>
#include <vector>

#include <crashsim/case.hpp>
#include <crashsim/sample_table.hpp>

namespace crashsim {

/// Whether a case asks for samples, by [sweep] or [monte_carlo].
bool has_samples(const Case& study);

/// The case itself, without samples.
Case without_samples(Case study);

/// What every sample shares.
struct SamplePlan {
  Case study;                     ///< Without its [sweep] and [monte_carlo].
  CaseResult base;                ///< Pulse, model and measured forcing of the case itself.
  std::vector<std::string> keys;  ///< What varies: "vehicle.mass", "crush.k3".
  SampleTable table;              ///< Without rows.
};

/// Plans the samples of a case from its own result.
/// @param base see run_case(); it must have a model.
/// @throws InvalidInput naming the key that cannot vary, or its number and the rule.
SamplePlan plan_samples(const Case& study, const CaseResult& base);

/// Numbers of a sample's inputs [SI].
std::vector<double> sample_inputs(const SampleTable& table, std::uint64_t sample);

/// Runs `count` samples from `first` on, fewer where the study ends. A row depends on the plan and its index only.
/// Where something varies that pulse or identification depend on, a sample is the whole chain; otherwise the model of
/// `base` is simulated with other numbers. Mass and speed are those of the vehicle simulated: the test stays as it was.
/// Numbers that a model cannot have make the outcome "invalid_input", what cannot be solved "numerical_failure".
/// @param progress is told of samples; when it stops them, those that are done are kept.
SampleTable run_samples(const SamplePlan& plan, std::uint64_t first, std::uint64_t count,
                        const Progress& progress = {});

/// Names of the files with the samples and what they say together.
inline constexpr std::string_view kSamples = "samples.csv";
inline constexpr std::string_view kSampleSummary = "sweep.json";

/// samples.csv: `sample`, the inputs, `outcome`, the outputs; one row a sample.
std::string format_samples(const SampleTable& table, const Record& record);

/// Reads samples.csv, of all samples or some of them, as rows of a study: for join_samples(). Numbers come back
/// exactly.
/// @param study the table of the plan. @throws InvalidInput with path and line when it is no such file.
SampleTable read_samples(const std::string& path, const SampleTable& study);

/// sweep.json: outcomes, statistics, correlations and Sobol' indices.
std::string format_sample_summary(const SampleTable& table, const SampleSummary& summary, const Record& record);

}  // namespace crashsim
