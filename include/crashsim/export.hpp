#pragma once
/// Models and traces for other programs: cards of finite-element solvers, tables, ISO-MME tests.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/crush_model.hpp>
#include <crashsim/options.hpp>
#include <crashsim/record.hpp>

namespace crashsim {

/// What is written: of a model an include file of LS-DYNA or OpenRadioss, or a table; of traces an ISO-MME test
/// (write_iso_mme()).
inline constexpr std::string_view kIsoMmeTarget = "iso-mme";
inline constexpr std::string_view kExportTargets[] = {"lsdyna", "radioss", "csv", kIsoMmeTarget};

struct ExportOptions {
  std::string to;  ///< One of kExportTargets.
  /// Of the deck: "kg-m-s", "t-mm-s", "kg-mm-ms", "g-mm-ms"; "": kg-m-s. Of traces as in ReadOptions. A table is in SI.
  std::string units = {};
  int first_id = 1;                        ///< Of curves, parts, materials, nodes and elements; each takes up to three.
  std::string test_name = {};              ///< Of an ISO-MME test; "": the name of the file it is made from.
  std::vector<std::string> channels = {};  ///< Of an ISO-MME test, as in ReadOptions; empty: all.

  bool operator==(const ExportOptions&) const = default;
};
inline constexpr int kLargestFirstId = 99999990;  // ids of elements have eight columns
inline constexpr std::array<Field<ExportOptions>, 5> kExportFields = {{
    {"to", "to", "", "what to write: lsdyna, radioss, csv, or of traces iso-mme", &ExportOptions::to},
    {"units", "units", "",
     "unit system of FE traces, or of the deck (default kg-m-s): kg-m-s, t-mm-s, kg-mm-ms, g-mm-ms",
     &ExportOptions::units},
    {"first_id", "id", "", "first number of curves, parts, materials, nodes and elements", &ExportOptions::first_id,
     between(1, kLargestFirstId)},
    {"test_name", "test", "", "name of an ISO-MME test; default: the file's", &ExportOptions::test_name},
    {"channels", "channel", "", "iso-mme: channel to write: name, number, code or glob; default: all",
     &ExportOptions::channels},
}};
template <>
inline constexpr std::span<const Field<ExportOptions>> fields<ExportOptions>{kExportFields};

/// Points of a force law for x or v >= 0, linear between them to within kCurveAccuracy of the largest force. The law is
/// odd: F(-x) = -F(x).
struct ForceCurve {
  std::vector<double> argument;  ///< Crush [m] or velocity [m/s], increasing from 0.
  std::vector<double> force_n;   ///< 0 at 0.
};
inline constexpr double kCurveAccuracy = 1e-3;

/// F_k(x), from 0 to half as far again as the last knot; to the last knot with extrapolation `error`. A spring law that
/// starts with a force f(0) > 0 is a steep line up to a thousandth of the last knot. Empty without a spring.
ForceCurve spring_curve(const CrushModel& model);

/// F_c(v), likewise. @throws InvalidInput for law `crush_damping`, unless its damping is the same at every crush.
ForceCurve damper_curve(const CrushModel& model);

/// A file for another program.
struct Exported {
  std::string text;
  std::vector<std::string> notes;  ///< What the cards cannot say, or say otherwise than the model; also in the text.
};

/// Writes the model for `options.to`, which is not kIsoMmeTarget.
/// lsdyna: *DEFINE_CURVE, *MAT_SPRING_NONLINEAR_ELASTIC (plastic unloading: *MAT_SPRING_GENERAL_NONLINEAR),
/// *MAT_DAMPER_NONLINEAR_VISCOUS with their *PART, *SECTION_DISCRETE, *ELEMENT_DISCRETE and *NODE. radioss: /FUNCT,
/// /PROP/TYPE4, /PART, /SPRING, /NODE. In both an element's deflection and force are positive in tension; crush is
/// compression. csv: x, k, F_k and v, c, F_c in columns, the shorter ones ending in empty cells; law `crush_damping` x
/// and c, law `rate` v and 1 + r ln(1 + v / v_ref) instead of the damper's. Law `rate` is a factor over velocity in the
/// cards, too; law `crush_damping` has none, unless its damping is the same at every crush.
/// @throws InvalidInput on a bad model or option; where the program has no card for the law; or where the restitution's
/// unloading stiffness is needed, but no
///         impact speed is known. NumericalFailure when there is no maximum crush to tell it from.
Exported export_model(const CrushModel& model, const ExportOptions& options, const Record& record);

}  // namespace crashsim
