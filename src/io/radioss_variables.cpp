#include "io/radioss_variables.hpp"

#include <iterator>
#include <span>

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {
namespace {

using D = Dimension;

constexpr RadiossVariable kGlobal[] = {{"INTERNAL ENERGY", D::energy},
                                       {"KINETIC ENERGY", D::energy},
                                       {"X-MOMENTUM", D::impulse},
                                       {"Y-MOMENTUM", D::impulse},
                                       {"Z-MOMENTUM", D::impulse},
                                       {"MASS", D::mass},
                                       {"TIME STEP", D::time},
                                       {"ROTATION ENERGY", D::energy},
                                       {"EXTERNAL WORK", D::energy},
                                       {"SPRING ENERGY", D::energy},
                                       {"CONTACT ENERGY", D::energy},
                                       {"HOURGLASS ENERGY", D::energy},
                                       {"ELASTIC CONTACT ENERGY", D::energy},
                                       {"FRICTIONAL CONTACT ENERGY", D::energy},
                                       {"DAMPING CONTACT ENERGY", D::energy},
                                       {"PLASTIC WORK", D::energy},
                                       {"ADDED MASS", D::mass},
                                       {"PERCENTAGE ADDED MASS", D::unknown},
                                       {"INLET MASS", D::mass},
                                       {"OUTLET MASS", D::mass},
                                       {"INLET ENERGY", D::energy},
                                       {"OUTLET ENERGY", D::energy}};

constexpr RadiossVariable kPart[] = {{"IE", D::energy},
                                     {"KE", D::energy},
                                     {"XMOM", D::impulse},
                                     {"YMOM", D::impulse},
                                     {"ZMOM", D::impulse},
                                     {"MASS", D::mass},
                                     {"HE", D::energy},
                                     {"TURBKE", D::energy},
                                     {"XCG", D::length},
                                     {"YCG", D::length},
                                     {"ZCG", D::length},
                                     {"XXMOM"},
                                     {"YYMOM"},
                                     {"ZZMOM"},
                                     {"IXX", D::inertia},
                                     {"IYY", D::inertia},
                                     {"IZZ", D::inertia},
                                     {"IXY", D::inertia},
                                     {"IYZ", D::inertia},
                                     {"IZX", D::inertia},
                                     {"RIE", D::energy},
                                     {"KERB", D::energy},
                                     {"RKERB", D::energy},
                                     {"RKE", D::energy},
                                     {"ERODED"},
                                     {},
                                     {},
                                     {"HEAT", D::energy},
                                     {"VX", D::speed},
                                     {"VY", D::speed},
                                     {"VZ", D::speed}};

constexpr RadiossVariable kNode[] = {{"DX", D::length},
                                     {"DY", D::length},
                                     {"DZ", D::length},
                                     {"VX", D::speed},
                                     {"VY", D::speed},
                                     {"VZ", D::speed},
                                     {"AX", D::acceleration},
                                     {"AY", D::acceleration},
                                     {"AZ", D::acceleration},
                                     {"VRX", D::angular_rate},
                                     {"VRY", D::angular_rate},
                                     {"VRZ", D::angular_rate},
                                     {"ARX", D::angular_acceleration},
                                     {"ARY", D::angular_acceleration},
                                     {"ARZ", D::angular_acceleration},
                                     {"X", D::length},
                                     {"Y", D::length},
                                     {"Z", D::length},
                                     {"TEMP"}};

/// Codes of nodes that follow the 600 of composite plies.
constexpr int kFirstReaction = 620;
constexpr RadiossVariable kReaction[] = {
    {"REACX", D::impulse}, {"REACY", D::impulse}, {"REACZ", D::impulse}, {"REACXX"}, {"REACYY"}, {"REACZZ"},
    {"DRX", D::angle},     {"DRY", D::angle},     {"DRZ", D::angle}};

constexpr RadiossVariable kTruss[] = {{"OFF"}, {"F", D::force}, {"IE", D::energy}, {"A"}, {"L", D::length}, {"PLAS"}};

constexpr RadiossVariable kBeam[] = {{"OFF"},           {"F1", D::force},  {"F2", D::force},  {"F3", D::force},
                                     {"M1", D::moment}, {"M2", D::moment}, {"M3", D::moment}, {"IE", D::energy}};

constexpr RadiossVariable kSpring[] = {{"OFF"},           {"FX", D::force},  {"FY", D::force},  {"FZ", D::force},
                                       {"MX", D::moment}, {"MY", D::moment}, {"MZ", D::moment}, {"LX", D::length},
                                       {"LY", D::length}, {"LZ", D::length}, {"RX", D::angle},  {"RY", D::angle},
                                       {"RZ", D::angle},  {"IE", D::energy}};

constexpr RadiossVariable kContact[] = {{"FNX", D::impulse},
                                        {"FNY", D::impulse},
                                        {"FNZ", D::impulse},
                                        {"FTX", D::impulse},
                                        {"FTY", D::impulse},
                                        {"FTZ", D::impulse},
                                        {"SFW", D::energy},
                                        {"|FNX|", D::impulse},
                                        {"|FNY|", D::impulse},
                                        {"|FNZ|", D::impulse},
                                        {"||FN||", D::impulse},
                                        {"|FX|", D::impulse},
                                        {"|FY|", D::impulse},
                                        {"|FZ|", D::impulse},
                                        {"||F||", D::impulse},
                                        {"PVOL"},
                                        {"PSURF"},
                                        {"PMED"},
                                        {"DELTAP"},
                                        {"VOL"},
                                        {"SURF"},
                                        {"MX"},
                                        {"MY"},
                                        {"MZ"},
                                        {"QFRIC", D::energy},
                                        {"CE_ELAST", D::energy},
                                        {"CE_FRIC", D::energy},
                                        {"CE_DAMP", D::energy}};

constexpr RadiossVariable kRigidBody[] = {{"FX", D::impulse},
                                          {"FY", D::impulse},
                                          {"FZ", D::impulse},
                                          {"MX"},
                                          {"MY"},
                                          {"MZ"},
                                          {"RX", D::angle},
                                          {"RY", D::angle},
                                          {"RZ", D::angle},
                                          {"FXI", D::impulse},
                                          {"FYI", D::impulse},
                                          {"FZI", D::impulse},
                                          {"MXI"},
                                          {"MYI"},
                                          {"MZI"}};

constexpr RadiossVariable kSection[] = {{"FNX", D::impulse},
                                        {"FNY", D::impulse},
                                        {"FNZ", D::impulse},
                                        {"FTX", D::impulse},
                                        {"FTY", D::impulse},
                                        {"FTZ", D::impulse},
                                        {"M1"},
                                        {"M2"},
                                        {"M3"},
                                        {"WORK", D::energy},
                                        {"DFX"},
                                        {"DFY"},
                                        {"DFZ"},
                                        {"DF2"},
                                        {"WORKR", D::energy},
                                        {"DMX"},
                                        {"DMY"},
                                        {"DMZ"},
                                        {"DM2"},
                                        {"KIN", D::energy},
                                        {"KINR", D::energy},
                                        {"DMVX"},
                                        {"DMVY"},
                                        {"DMVZ"},
                                        {"DKIN"},
                                        {"DMVRX"},
                                        {"DMVRY"},
                                        {"DMVRZ"},
                                        {"DKINR"},
                                        {"TFEXT", D::energy},
                                        {"MX"},
                                        {"MY"},
                                        {"MZ"},
                                        {"F1", D::impulse},
                                        {"F2", D::impulse},
                                        {"F3", D::impulse},
                                        {"CX", D::length},
                                        {"CY", D::length},
                                        {"CZ", D::length}};

/// Whether joints write forces or impulses the public sources do not agree on.
constexpr RadiossVariable kJoint[] = {{"FX"}, {"FY"}, {"FZ"}, {"MX"}, {"MY"}, {"MZ"}};

/// W is the integral of the filtered acceleration.
constexpr RadiossVariable kAccelerometer[] = {{"AX", D::acceleration}, {"AY", D::acceleration}, {"AZ", D::acceleration},
                                              {"WX", D::speed},        {"WY", D::speed},        {"WZ", D::speed}};

RadiossVariable of_code(std::span<const RadiossVariable> variables, int code, int first = 1) {
  if (code < first || code - first >= std::ssize(variables)) return {};
  return variables[static_cast<std::size_t>(code - first)];
}

}  // namespace

RadiossVariable radioss_global_variable(int code) { return of_code(kGlobal, code); }

RadiossVariable radioss_part_variable(int code) { return of_code(kPart, code); }

RadiossVariable radioss_group_variable(int kind, int code) {
  switch (kind) {
    case kRadiossNodes:
      return code >= kFirstReaction ? of_code(kReaction, code, kFirstReaction) : of_code(kNode, code);
    case 4:
      return of_code(kTruss, code);
    case 5:
      return of_code(kBeam, code);
    case 6:
      return of_code(kSpring, code);
    case 101:
      return of_code(kContact, code);
    case kRadiossWalls:
      return of_code(std::span(kContact).first<6>(), code);
    case 103:
      return of_code(kRigidBody, code);
    case 104:
      return of_code(kSection, code);
    case 105:
      return of_code(kJoint, code);
    case 108:
      return of_code(kAccelerometer, code);
    default:
      return {};
  }
}

Trace radioss_trace(const std::string& entity, const std::string& variable, Dimension dimension, std::size_t column) {
  Trace trace;
  trace.id = std::to_string(column);
  trace.name = entity.empty() ? variable : fmt::format("{}_{}", entity, variable);
  trace.location = entity;
  trace.dimension = dimension;
  trace.has_samples = false;
  const char last = variable.empty() ? ' ' : variable.back();
  if (!entity.empty() && last >= 'X' && last <= 'Z') trace.axis = last;
  return trace;
}

}  // namespace crashsim::io
