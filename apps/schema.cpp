/// crashsim schema: the keys of the files that people write.

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.hpp"

namespace crashsim::cli {
namespace {

std::string as_text(const std::vector<FileKey>& keys) {
  std::string text;
  const std::string* section = nullptr;
  for (const FileKey& key : keys) {
    if (section == nullptr || *section != key.section) {
      if (!key.section.empty()) text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", key.section);
      section = &key.section;
    }
    std::string notes;
    const auto note = [&](const std::string& what) { notes += notes.empty() ? what : "; " + what; };
    if (!key.about.unit.empty()) note("in " + key.about.unit);
    if (!key.about.range.empty()) note(key.about.range);
    if (!key.about.choices.empty()) note("one of " + key.about.choices);
    if (!key.about.default_value.empty()) note("default " + key.about.default_value);
    text += fmt::format("{:<24} {}{}\n", key.key, key.about.doc, notes.empty() ? "" : " (" + notes + ")");
  }
  return text;
}

std::string as_json(const std::vector<FileKey>& keys) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const FileKey& key : keys)
    list.push_back({{"section", key.section},
                    {"key", key.key},
                    {"unit", key.about.unit},
                    {"doc", key.about.doc},
                    {"default", key.about.default_value},
                    {"range", key.about.range},
                    {"choices", key.about.choices}});
  return list.dump(2) + "\n";
}

class SchemaCommand : public Command {
 public:
  explicit SchemaCommand(CLI::App& parent)
      : Command(parent, "schema", "List the keys of a case, model or vehicle file: meaning, unit, range, default",
                "crashsim schema case") {
    app().add_option("kind", kind_, "case, model or vehicle")->required()->type_name("KIND");
    add_reporting();
  }

  int run() override {
    resolve();
    const std::vector<FileKey> keys = keys_of_kind();
    write_output("-", json() ? as_json(keys) : as_text(keys), false);
    return kDone;
  }

 private:
  [[nodiscard]] std::vector<FileKey> keys_of_kind() const {
    if (kind_ == "case") return case_keys();
    if (kind_ == "model") return model_keys();
    if (kind_ == "vehicle") return vehicle_keys();
    detail::throw_unknown_name("schema", kind_, {"case", "model", "vehicle"});
  }

  std::string kind_;
};

}  // namespace

std::unique_ptr<Command> make_schema(CLI::App& app) { return std::make_unique<SchemaCommand>(app); }

}  // namespace crashsim::cli
