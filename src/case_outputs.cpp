/// What a case leaves behind: its summary and the files of its directory.

#include <fmt/format.h>

#include <crashsim/case.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/outputs.hpp>
#include <crashsim/sweep.hpp>

#include "case_sections.hpp"
#include "case_steps.hpp"

namespace crashsim {
namespace {

constexpr const char* kPulse = "pulse.csv";
constexpr const char* kModel = "model.json";
constexpr const char* kResponse = "response.csv";
constexpr const char* kPitch = "pitch.csv";
constexpr const char* kCoupled = "coupled.csv";
constexpr const char* kComparison = "comparison.json";
constexpr const char* kRecord = "case.lock.json";

std::string prediction_file(double speed_mps) { return fmt::format("prediction_{}.csv", prediction_name(speed_mps)); }

/// Overall ratings of one comparison, channel by channel.
Summary ratings_of(const Comparison& comparison) {
  Summary ratings;
  for (const ChannelComparison& channel : comparison.channels)
    ratings.push_back({channel.name, channel.rating.overall, "ISO/TS 18571 rating of " + channel.name});
  return ratings;
}

}  // namespace

std::string outcome_of(const CaseResult& out) {
  const bool has_motion = out.response.outcome != CrushOutcome::not_run;
  if (!has_motion && out.identification) return std::string(name_of(out.identification->outcome));
  if (!out.response.usable()) return std::string(name_of(out.response.outcome));
  if (out.pitch && !out.pitch->usable()) return std::string(name_of(out.pitch->outcome));
  if (out.coupled) return std::string(name_of(out.coupled->outcome));
  return std::string(name_of(out.response.outcome));
}

Summary summarize(const CaseResult& result) {
  if (result.response.outcome == CrushOutcome::not_run) return {{"outcome", outcome_of(result), "outcome"}};
  Summary summary = summarize(result.response, result.model.mass_kg);
  auto& outcome = std::get<std::string>(summary.front().value);
  outcome = outcome_of(result);
  for (const Prediction& prediction : result.predictions)  // the first that failed is the outcome of all
    if (outcome == name_of(CrushOutcome::completed)) outcome = name_of(prediction.response.outcome);
  if (!result.pitch) return summary;
  const Summary pitch = summarize(*result.pitch);
  summary.insert(summary.end(), pitch.begin() + 1, pitch.end());
  return summary;
}

std::vector<std::pair<std::string, Summary>> summary_parts(const CaseResult& result) {
  std::vector<std::pair<std::string, Summary>> parts;
  if (result.pulse) parts.emplace_back("pulse", summarize(*result.pulse));
  if (result.identification) {
    Summary fit = summarize(*result.identification);
    std::erase_if(fit, [](const SummaryItem& item) { return item.name == "seconds"; });  // the same bytes every time
    parts.emplace_back("identification", std::move(fit));
  }
  if (result.coupled) parts.emplace_back("coupled", summarize(*result.coupled));
  for (const NamedComparison& comparison : result.comparisons)
    parts.emplace_back("rating_" + comparison.name, ratings_of(comparison.result));
  for (const Prediction& prediction : result.predictions)
    parts.emplace_back("prediction_" + prediction.name, summarize(prediction.response, result.model.mass_kg));
  return parts;
}

std::vector<std::string> case_file_names(const Case& study) {
  std::vector<std::string> names;
  if (!study.what.pulse_file.empty()) names.emplace_back(kPulse);
  names.insert(names.end(), {kModel, kResponse});
  if (has_pitch(study)) names.emplace_back(kPitch);
  if (has_pitch(study) && study.what.coupled) names.emplace_back(kCoupled);
  for (const double speed : study.what.speeds_mps) names.push_back(prediction_file(speed));
  if (!study.what.pulse_file.empty() || !study.measured.file.empty()) names.emplace_back(kComparison);
  if (has_samples(study)) names.insert(names.end(), {std::string(kSamples), std::string(kSampleSummary)});
  names.insert(names.end(), {std::string(kCaseSummary), kRecord});
  return names;
}

std::vector<FileText> case_files(const Case& study, const CaseResult& result) {
  const Record record = make_record("run", {study.path}, entries_of(study), result.input_files);
  std::vector<FileText> files;
  if (result.pulse) files.push_back({kPulse, format_pulse(*result.pulse, record)});
  if (result.response.outcome != CrushOutcome::not_run) {
    const Identification* fit = result.identification ? &*result.identification : nullptr;
    files.push_back({kModel, format_model(result.model, fit, &record)});
    files.push_back({kResponse, format_response(result.response, result.model.mass_kg, record)});
  }
  if (result.pitch) files.push_back({kPitch, format_pitch(*result.pitch, record)});
  if (result.coupled) files.push_back({kCoupled, format_coupled(*result.coupled, record)});
  for (std::size_t i = 0; i < result.predictions.size(); ++i)
    files.push_back({prediction_file(study.what.speeds_mps[i]),
                     format_response(result.predictions[i].response, result.model.mass_kg, record)});
  if (!result.comparisons.empty()) files.push_back({kComparison, format_comparisons(result.comparisons, record)});
  if (result.samples) {
    files.push_back({std::string(kSamples), format_samples(*result.samples, record)});
    files.push_back({std::string(kSampleSummary),
                     format_sample_summary(*result.samples, summarize_samples(*result.samples), record)});
  }
  files.push_back({std::string(kCaseSummary), format_summary(summarize(result), summary_parts(result))});
  files.push_back({kRecord, format_record(record)});
  return files;
}

}  // namespace crashsim
