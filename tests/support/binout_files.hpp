#pragma once
/// LS-DYNA runs made up for tests, and the binout files that hold them.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "support/lsda_writer.hpp"
#include "support/random.hpp"

namespace crashsim::test {

/// One database of a run.
struct BinoutDatabase {
  std::string path;                    ///< "nodout", "rwforc/forces".
  std::vector<int> ids;                ///< None for quantities of the whole model.
  std::vector<std::string> variables;  ///< Beside the time.
  std::vector<double> times;
  std::vector<std::vector<std::vector<double>>> values;  ///< By state, variable, entity.
};
using BinoutData = std::vector<BinoutDatabase>;

/// A database without values: `states` times from 0 on.
inline BinoutDatabase random_database(Random& random, std::string path, int entities,
                                      std::vector<std::string> variables, int states) {
  BinoutDatabase database{std::move(path), {}, std::move(variables), {}, {}};
  for (int i = 0; i < entities; ++i) database.ids.push_back(100 + 7 * i);
  double time = 0.0;
  for (int s = 0; s < states; ++s, time += random.between(0.0005, 0.001)) {
    database.times.push_back(static_cast<double>(static_cast<float>(time)));  // the same in single precision
    auto& state = database.values.emplace_back();
    for (std::size_t v = 0; v < database.variables.size(); ++v)
      for (int i = 0; i < std::max(entities, 1); ++i) {
        if (i == 0) state.emplace_back();
        state.back().push_back(static_cast<double>(static_cast<float>(random.between(-9.0, 9.0))));
      }
  }
  return database;
}

inline BinoutData random_binout(Random& random, int most_states = 9) {
  const auto states = [&] { return random.whole(1, most_states); };
  return {random_database(random, "nodout", random.whole(2, 150), {"x_displacement", "x_velocity", "rz_velocity"},
                          states()),
          random_database(random, "rwforc/forces", random.whole(1, 3), {"normal_force", "x_force"}, states()),
          random_database(random, "glstat", 0, {"kinetic_energy", "added_mass"}, states())};
}

/// Writes what does not change.
inline void write_metadata(LsdaWriter& writer, const BinoutDatabase& database, const std::string& title = "A RUN") {
  writer.cd(fmt::format("/{}/metadata", database.path));
  writer.write("title", title, 80);
  writer.write("version", "smp d R13", 12);
  if (!database.ids.empty()) writer.write("ids", database.ids);
}

/// Writes one state, as the one of a number (from 1).
template <class Real>
void write_state(LsdaWriter& writer, const BinoutDatabase& database, std::size_t state, std::size_t number) {
  writer.cd(fmt::format("/{}/d{:06}", database.path, number));
  writer.write("time", static_cast<Real>(database.times[state]));
  for (std::size_t v = 0; v < database.variables.size(); ++v) {
    const auto& values = database.values[state][v];
    writer.write(database.variables[v], std::vector<Real>(values.begin(), values.end()));
  }
}

/// Writes the states [first, last) of all databases, the symbol table after each.
template <class Real>
void write_states(LsdaWriter& writer, const BinoutData& data, std::size_t first, std::size_t last) {
  for (std::size_t state = first; state < last; ++state) {
    for (const BinoutDatabase& database : data)
      if (state < database.times.size()) write_state<Real>(writer, database, state, state + 1);
    writer.save();
  }
}

inline constexpr std::size_t kAllStates = 1000;

/// A file of the whole run, of its values as numbers of type Real.
template <class Real>
std::string binout_bytes(const BinoutData& data, const LsdaFormat& format = {}) {
  LsdaWriter writer(format);
  for (const BinoutDatabase& database : data) write_metadata(writer, database);
  write_states<Real>(writer, data, 0, kAllStates);
  return writer.bytes();
}

/// Times and values of each channel by its id.
inline std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> channels_of(const BinoutData& data) {
  std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> channels;
  for (const BinoutDatabase& d : data)
    for (std::size_t s = 0; s < d.times.size(); ++s)
      for (std::size_t v = 0; v < d.variables.size(); ++v)
        for (std::size_t i = 0; i < d.values[s][v].size(); ++i) {
          const std::string name = d.path == "rwforc/forces" ? "rwforc" : d.path;
          const std::string entity = d.ids.empty() ? "" : fmt::format("{}/", d.ids[i]);
          auto& [times, values] = channels[fmt::format("{}/{}{}", name, entity, d.variables[v])];
          times.push_back(d.times[s]);
          values.push_back(d.values[s][v][i]);
        }
  return channels;
}

}  // namespace crashsim::test
