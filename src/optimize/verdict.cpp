#include "optimize/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "optimize/identifiability.hpp"

namespace crashsim {
namespace {

using Eigen::Index;

constexpr double kWellConditioned = 50.0;  // one speed gives 125 with 7 + 7 knots, two speeds 10
constexpr double kSeparable = 0.999;       // cosine between the closest directions of spring and damper
constexpr double kAtBound = 1e-6;          // relative to the upper bound

/// Orthonormal basis of a matrix's column space.
Eigen::MatrixXd column_basis(const Eigen::MatrixXd& a) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  return Eigen::MatrixXd(qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), qr.rank()));
}

double largest_cosine(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.cols() == 0 || b.cols() == 0) return kUnset;
  const Eigen::MatrixXd overlap = column_basis(a).transpose() * column_basis(b);
  if (overlap.size() == 0) return kUnset;
  return std::min(1.0, Eigen::JacobiSVD<Eigen::MatrixXd>(overlap).singularValues()[0]);
}

std::string explain(const Verdict& verdict, Index touched, std::size_t untouched, std::size_t tests) {
  const std::string from = tests == 1 ? "one speed" : fmt::format("{} tests", tests);
  std::string text;
  if (verdict.identifiable) {
    text = fmt::format("every ordinate is determined (rank {} of {}, condition {:.3g})", verdict.rank, touched,
                       verdict.condition);
  } else if (!std::isnan(verdict.spring_damper_cosine) && verdict.spring_damper_cosine > kSeparable) {
    text = fmt::format(
        "spring and damper are not separable from {}: only their total force is determined (rank {} of {}, condition "
        "{:.3g}, closest directions of spring and damper: cosine {:.5f}); a joint fit of several speeds, fewer knots "
        "or "
        "smoothing separates them",
        from, verdict.rank, touched, verdict.condition, verdict.spring_damper_cosine);
  } else {
    text = fmt::format(
        "the ordinates are not well determined from {} (rank {} of {}, condition {:.3g}): use fewer knots, smoothing "
        "or "
        "more tests",
        from, verdict.rank, touched, verdict.condition);
  }
  if (untouched > 0) text += fmt::format("; {} ordinate{} no sample depends on", untouched, untouched == 1 ? "" : "s");
  return text;
}

/// Names and parts of a structure's parameters, in their order.
std::vector<OrdinateReport> name_parameters(const FitStructure& structure) {
  std::vector<OrdinateReport> reports;
  const auto add = [&reports](std::string_view letter, std::size_t first, std::size_t count, FittedPart part) {
    for (std::size_t i = 0; i < count; ++i) {
      reports.emplace_back();
      reports.back().name = fmt::format("{}{}", letter, first + i);
      reports.back().part = part;
    }
  };
  add("k", 1, structure.springs(), FittedPart::spring);
  add("c", 1, structure.dampers(), FittedPart::damper);
  if (structure.has_rate()) {
    add("r", 1, 1, FittedPart::rate);
    reports.back().name = "r";
  }
  add("x", 2, structure.free_springs(), FittedPart::spring_knot);
  add(structure.law == CrushLaw::crush_damping ? "d" : "v", 2, structure.free_dampers(), FittedPart::damper_knot);
  return reports;
}

std::vector<OrdinateReport> describe(const FitStructure& structure, std::span<const double> parameters,
                                     const Eigen::VectorXd& upper, const std::vector<bool>& touched) {
  std::vector<OrdinateReport> reports = name_parameters(structure);
  for (std::size_t i = 0; i < reports.size(); ++i) {
    OrdinateReport& report = reports[i];
    report.value = parameters[i];
    report.upper_bound = upper[static_cast<Index>(i)];
    report.untouched = !touched[i];
    report.at_bound =
        parameters[i] <= kAtBound * report.upper_bound || parameters[i] >= (1.0 - kAtBound) * report.upper_bound;
  }
  // A knot's parameter is its distance from its lowest place.
  const FitKnots knots = knots_of(structure, parameters);
  const auto place = [&](std::size_t first, std::size_t count, const std::vector<double>& places) {
    for (std::size_t i = 0; i < count; ++i) {
      OrdinateReport& report = reports[first + i];
      report.upper_bound += places[i + 1] - report.value;
      report.value = places[i + 1];
    }
  };
  place(structure.first_knot(), structure.free_springs(), knots.spring);
  place(structure.first_knot() + structure.free_springs(), structure.free_dampers(), knots.damper);
  return reports;
}

}  // namespace

void hold_untouched(const FitStructure& structure, const std::vector<bool>& touched, std::span<double> parameters) {
  const auto hold = [&](std::size_t first, std::size_t count) {
    const auto end = static_cast<std::ptrdiff_t>(first + count);
    for (auto i = static_cast<std::ptrdiff_t>(first); i < end; ++i) {
      if (touched[static_cast<std::size_t>(i)]) continue;
      for (std::ptrdiff_t distance = 1; distance < static_cast<std::ptrdiff_t>(count); ++distance)
        for (const std::ptrdiff_t j : {i - distance, i + distance}) {
          if (j < static_cast<std::ptrdiff_t>(first) || j >= end || !touched[static_cast<std::size_t>(j)]) continue;
          parameters[static_cast<std::size_t>(i)] = parameters[static_cast<std::size_t>(j)];
          distance = end;
          break;
        }
    }
  };
  hold(0, structure.springs());
  hold(structure.springs(), structure.dampers());
}

Identifiability judge_identifiability(const FitStructure& structure, std::span<const double> parameters,
                                      const Eigen::VectorXd& upper, const Eigen::MatrixXd& jacobian,
                                      const Eigen::MatrixXd& roughness, double residual_variance, std::size_t tests) {
  const std::vector<bool> touched = touched_columns(jacobian, upper);
  Eigen::MatrixXd stacked(jacobian.rows() + roughness.rows(), jacobian.cols());
  stacked << jacobian, roughness;
  const ColumnAnalysis analysis = analyse_columns(stacked, upper);
  const std::vector<std::size_t>& determined = analysis.determined;
  ParameterErrors errors = errors_of(analysis, residual_variance);
  Identifiability out;
  out.ordinates = describe(structure, parameters, upper, touched);
  for (std::size_t i = 0; i < out.ordinates.size(); ++i) out.ordinates[i].standard_error = errors.standard_errors[i];
  out.correlation = std::move(errors.correlation);
  if (determined.empty()) {
    out.verdict.message = "no sample depends on any ordinate";
    return out;
  }
  const auto count = static_cast<Index>(determined.size());
  const Index springs = std::ranges::lower_bound(determined, structure.springs()) - determined.begin();
  const Index ordinates = std::ranges::lower_bound(determined, structure.first_knot()) - determined.begin();
  out.verdict.rank = analysis.rank;
  out.verdict.condition = analysis.condition;
  out.verdict.spring_damper_cosine =
      largest_cosine(analysis.columns.leftCols(springs), analysis.columns.middleCols(springs, ordinates - springs));
  out.verdict.identifiable =
      analysis.has_full_rank() && determined.size() == parameters.size() && analysis.condition <= kWellConditioned;
  const auto untouched = static_cast<std::size_t>(std::count(touched.begin(), touched.end(), false));
  out.verdict.message = explain(out.verdict, count, untouched, tests);
  return out;
}

}  // namespace crashsim
