#pragma once
/// Which options stand in which table of a case file: the one list from which cases are read, recorded and documented.

#include <algorithm>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <crashsim/case.hpp>

namespace crashsim {

/// A path in a case file as seen from where the program runs.
std::string resolved(const Case& study, const std::string& path);

/// Whether heave and pitch are to be simulated: the case describes the vehicle on its axles, or a force on it.
bool has_pitch(const Case& study);

/// What a prediction is called: "40kmh".
std::string prediction_name(double speed_mps);

/// A table of the case file that holds fields of one options struct.
template <class S>
struct CaseSection {
  std::string_view name;
  S Case::*member;
  std::vector<std::string_view> only;    ///< Flags that stand here; empty: all but `except`.
  std::vector<std::string_view> except;  ///< Flags that do not.

  [[nodiscard]] bool offers(const Field<S>& field) const {
    const auto holds = [&](const std::vector<std::string_view>& list) {
      return std::find(list.begin(), list.end(), field.flag) != list.end();
    };
    return only.empty() ? !holds(except) : holds(only);
  }
};

inline auto case_sections() {
  // fields of the identification that describe the model
  const std::vector<std::string_view> crush = {"law",   "spring-knots", "damper-knots",
                                               "knots", "curve",        "reference-speed"};
  std::vector<std::string_view> not_in_identify = crush;
  not_in_identify.emplace_back("mass");
  return std::tuple(CaseSection<HeavePitchModel>{"vehicle", &Case::vehicle, {}, {"mass", "formulation"}},
                    CaseSection<PulseOptions>{"pulse", &Case::pulse, {}, {"mass", "speed"}},
                    CaseSection<IdentifyOptions>{"crush", &Case::identify, crush, {}},
                    CaseSection<IdentifyOptions>{"identify", &Case::identify, {}, not_in_identify},
                    CaseSection<SimulateOptions>{"simulate", &Case::simulation, {}, {"speed", "times"}},
                    CaseSection<ForcingOptions>{"pitch", &Case::forcing, {}, {}},
                    CaseSection<HeavePitchModel>{"pitch", &Case::vehicle, {"formulation"}, {}},
                    CaseSection<PitchOptions>{"pitch", &Case::motion, {}, {}},
                    CaseSection<VerticalForceLaw>{"pitch", &Case::vertical, {}, {}},
                    CaseSection<GroundContact>{"vehicle", &Case::ground, {}, {}},
                    CaseSection<MotionOptions>{"compare", &Case::measured, {}, {}},
                    CaseSection<CompareOptions>{"compare", &Case::comparison, {}, {}},
                    CaseSection<DesignOptions>{"design", &Case::design, {}, {}},
                    CaseSection<MonteCarloOptions>{"monte_carlo", &Case::monte_carlo, {}, {}});
}

/// Where an option stands in a case file.
struct Place {
  std::string section, key;
};

/// Where a field stands and what it is called there: its flag with '_', a list by its name ("channels"). The flag of a
/// field of CaseOptions holds both: "pulse.file".
template <class S>
Place place_of(std::string_view section, const Field<S>& field) {
  const bool is_list = std::holds_alternative<std::vector<std::string> S::*>(field.member);
  std::string key(is_list && !section.empty() ? field.name : field.flag);
  std::replace(key.begin(), key.end(), '-', '_');
  const std::size_t dot = key.find('.');
  if (!section.empty() || dot == std::string::npos) return {std::string(section), key};
  return {key.substr(0, dot), key.substr(dot + 1)};
}

/// The key of an option; `force = {file = ..}` in [pitch] and `motion = {file = ..}` in [compare] are tables.
inline std::string_view option_key(std::string_view section_of_key, std::string_view key) {
  for (const auto& [section, table] :
       {std::pair("pitch", std::string_view("force.")), std::pair("compare", std::string_view("motion."))})
    if (section_of_key == section && key.starts_with(table)) return key.substr(table.size());
  return key;
}

/// Calls visit(section name, field, options of that section) for every key; the fields of CaseOptions name their own
/// section in their flag ("pulse.file").
template <class SomeCase, class Visit>
void for_each_key(SomeCase& study, Visit visit) {
  for (const Field<CaseOptions>& field : fields<CaseOptions>) visit(std::string_view(), field, study.what);
  const auto visit_section = [&](const auto& section) {
    auto& options = study.*section.member;
    using S = std::remove_cvref_t<decltype(options)>;
    for (const Field<S>& field : fields<S>)
      if (section.offers(field)) visit(section.name, field, options);
  };
  std::apply([&](const auto&... section) { (visit_section(section), ...); }, case_sections());
}

}  // namespace crashsim
