#include "io/nhtsa_fields.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {
namespace {

/// Names in the order of a record; "BX*21" stands for BX1 to BX21.
constexpr std::string_view kTest[] = {"VERNO",  "TITLE",  "TSTOBJ", "TSTDAT", "TSTPRF", "CONNO",  "TSTREF",
                                      "TSTTYP", "TSTCFN", "TKSURF", "TKCOND", "TEMP",   "RECTYP", "LINK",
                                      "CLSSPD", "IMPANG", "OFFSET", "IMPPNT", "TOTCRV", "TSTCOM"};
constexpr std::string_view kVehicle[] = {
    "VEHNO",  "MAKE",   "MODEL",  "YEAR",   "NHTSANO", "BODY",   "VIN",    "ENGINE", "ENGDSP",
    "TRANSM", "VEHTWT", "CURBWT", "WHLBAS", "VEHLEN",  "VEHWID", "VEHCG",  "STRSEP", "COLMEC",
    "MODIND", "MODDSC", "BX*21",  "VEHSPD", "CRBANG",  "PDOF",   "BMPENG", "SILENG", "APLENG",
    "DPD*6",  "VDI",    "LENCNT", "DAMDST", "CRHDST",  "AX*21",  "CARANG", "VEHOR",  "VEHCOM"};
constexpr std::string_view kBarrier[] = {"BARRIG", "BARSHP", "BARANG", "BARDIA", "BARCOM"};
constexpr std::string_view kOccupant[] = {
    "VEHNO",  "OCCLOC", "OCCTYP", "OCCAGE", "OCCSEX", "OCCHT",  "OCCWT",  "MTHCAL", "DUMSIZ", "DUMMAN", "DUMMOD",
    "DUMDSC", "HH",     "HW",     "HR",     "HS",     "CD",     "CS",     "AD",     "HD",     "KD",     "HB",
    "NB",     "CB",     "KB",     "SEPOSN", "CNTRH1", "CNTRH2", "CNTRC1", "CNTRC2", "CNTRL1", "CNTRL2", "HIC",
    "T1",     "T2",     "CLIP3M", "LFEM",   "RFEM",   "CSI",    "LBELT",  "SBELT",  "TTI",    "PELVG",  "OCCCOM"};
constexpr std::string_view kRestraint[] = {"VEHNO", "OCCLOC", "RSTNO", "RSTTYP", "RSTMNT", "DEPLOY", "RSTCOM"};
constexpr std::string_view kInstrumentation[] = {"VEHNO",  "CURNO",  "SENTYP", "SENLOC", "SENATT", "AXIS",   "XUNITS",
                                                 "YUNITS", "PREFIL", "INSMAN", "CALDAT", "INSRAT", "CHLMAX", "INIVEL",
                                                 "NFP",    "NLP",    "DELT",   "DASTAT", "CHSTAT", "INSCOM"};
constexpr std::string_view kHeldByTrace[] = {"CURNO", "SENATT", "XUNITS", "YUNITS", "NFP", "NLP", "DELT", "INSCOM"};

/// More than any test has; keeps a file of bars from filling the memory.
constexpr std::size_t kMostFields = 100'000;

struct Section {
  std::string_view name;
  std::span<const std::string_view> fields;
  std::span<const std::string_view> keys;  ///< Fields that tell its records apart.
};
constexpr std::string_view kVehicleKey[] = {"VEHNO"};
constexpr std::string_view kOccupantKey[] = {"VEHNO", "OCCLOC"};
constexpr std::string_view kRestraintKey[] = {"VEHNO", "OCCLOC", "RSTNO"};
constexpr std::string_view kInstrumentationKey[] = {"CURNO"};
constexpr Section kSections[] = {
    {"TEST", kTest, {}},
    {"VEHICLE", kVehicle, kVehicleKey},
    {"BARRIER", kBarrier, {}},
    {"OCCUPANT", kOccupant, kOccupantKey},
    {"RESTRAINT", kRestraint, kRestraintKey},
    {"INSTRUMENTATION", kInstrumentation, kInstrumentationKey},
};

/// The names with "BX*21" written out.
std::vector<std::string> written_out(std::span<const std::string_view> fields) {
  std::vector<std::string> names;
  for (const std::string_view field : fields) {
    const std::size_t star = field.find('*');
    if (star == std::string_view::npos) {
      names.emplace_back(field);
      continue;
    }
    const int count = std::stoi(std::string(field.substr(star + 1)));
    for (int i = 1; i <= count; ++i) names.push_back(fmt::format("{}{}", field.substr(0, star), i));
  }
  return names;
}

const Section* find_section(std::string_view name) {
  const auto found =
      std::find_if(std::begin(kSections), std::end(kSections), [&](const Section& s) { return s.name == name; });
  return found == std::end(kSections) ? nullptr : &*found;
}

const std::vector<std::string>& names_of(const Section& section) {
  static const std::vector<std::vector<std::string>> all = [] {
    std::vector<std::vector<std::string>> lists;
    for (const Section& s : kSections) lists.push_back(written_out(s.fields));
    return lists;
  }();
  return all[static_cast<std::size_t>(&section - kSections)];
}

/// "[1,01]", "" for a section with one record. An empty key field is left empty.
std::string key_of(const Section& section, const std::vector<std::string_view>& fields) {
  if (section.keys.empty()) return "";
  const auto& names = names_of(section);
  std::string key;
  for (const std::string_view name : section.keys) {
    const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    const std::string_view value = at < fields.size() ? trimmed(fields[at]) : std::string_view();
    key += fmt::format("{}{}", key.empty() ? "[" : ",", value);
  }
  return key + "]";
}

}  // namespace

std::string nhtsa_field_name(std::string_view section, std::size_t index) {
  const Section* known = find_section(section);
  if (known != nullptr && index < names_of(*known).size()) return names_of(*known)[index];
  return fmt::format("FIELD{}", index + 1);
}

void append_nhtsa_fields(std::string_view section, const std::vector<std::string_view>& fields, Metadata& metadata) {
  const Section* known = find_section(section);
  const std::string prefix = fmt::format("{}{}.", section, known == nullptr ? "" : key_of(*known, fields));
  const bool of_channel = section == "INSTRUMENTATION";
  for (std::size_t i = 0; i < fields.size() && metadata.size() < kMostFields; ++i) {
    const std::string_view value = trimmed(fields[i]);
    if (value.empty()) continue;
    const std::string name = nhtsa_field_name(section, i);
    const bool held =
        of_channel && std::find(std::begin(kHeldByTrace), std::end(kHeldByTrace), name) != std::end(kHeldByTrace);
    if (!held) metadata.emplace_back(prefix + name, value);
  }
}

}  // namespace crashsim::io
