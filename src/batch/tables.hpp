#pragma once
/// The tables of a batch, row by row.

#include <string>
#include <vector>

#include <crashsim/batch.hpp>

namespace crashsim::batch {

inline constexpr const char* kTableCsv = "results.csv";
inline constexpr const char* kTableJson = "results.jsonl";
inline constexpr const char* kTimings = "timings.csv";

/// Header and row of results.csv: case, outcome, message, then the summary keys and some of the identification.
std::string results_header();
std::string results_line(const BatchRow& row);

/// Row of results.jsonl: case, outcome, message, then all of summary.json.
std::string results_json(const BatchRow& row);

/// Header and row of timings.csv.
std::string timings_header();
std::string timings_line(const BatchRow& row);

}  // namespace crashsim::batch
