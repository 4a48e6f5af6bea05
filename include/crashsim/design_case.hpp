#pragma once
/// The design study that a case asks for in [design], and the files it leaves behind.

#include <string>
#include <vector>

#include <crashsim/case.hpp>
#include <crashsim/design.hpp>
#include <crashsim/simulate_coupled.hpp>

namespace crashsim {

/// What the design study of a case gives.
struct DesignCaseResult {
  CaseResult base;           ///< The case as `run` has it: what the crush model comes from.
  CoupledModel model;        ///< The model before the design.
  DesignResult design;       ///< Not run where there is no crush model.
  CoupledResponse response;  ///< Of the optimum; not run where there is none.
  std::vector<std::string> notes;

  [[nodiscard]] bool usable() const {
    return (!base.identification || base.identification->usable()) && design.usable();
  }
};

/// Runs a case and the design study on its crush model, [vehicle] and vertical force of [pitch]. The motion ends at the
/// `end` of [pitch], else of [simulate], else after 0.3 s.
/// @throws InvalidInput on bad options, files or values.
DesignCaseResult run_design(const Case& study, const Progress& progress = {});

/// Name of the file with optimum, limits and what changed.
inline constexpr std::string_view kDesignSummary = "design.json";

/// Responses before and after the design.
Summary summarize(const DesignResponses& responses);

/// Names of the files that a design study will write, in the order of design_files().
std::vector<std::string> design_file_names(const Case& study);

/// sensitivities.csv, trade_off.csv, model.json and coupled.csv of the optimum, design.json and, last, case.lock.json,
/// the record.
std::vector<FileText> design_files(const Case& study, const DesignCaseResult& result);

}  // namespace crashsim
