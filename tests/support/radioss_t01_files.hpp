#pragma once
/// OpenRadioss binary time histories as text that tests can predict: any layout, random contents.

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "support/random.hpp"

namespace crashsim::test {

/// Big-endian words, and records of them with their length before and after.
inline std::string word(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xffU);
  return bytes;
}
inline std::string word(float value) { return word(std::bit_cast<std::uint32_t>(value)); }
inline std::string word(int value) { return word(static_cast<std::uint32_t>(value)); }
inline std::string words(const std::vector<int>& values) {
  std::string bytes;
  for (const int value : values) bytes += word(value);
  return bytes;
}
inline std::string fortran_record(std::string_view payload) {
  const std::string length = word(static_cast<std::uint32_t>(payload.size()));
  return length + std::string(payload) + length;
}
inline std::string padded(std::string text, std::size_t length) {
  text.resize(length, ' ');
  return text;
}

/// A file and what it holds.
struct RadiossT01File {
  std::string bytes;
  std::size_t header_bytes = 0, state_bytes = 0;
  std::vector<std::string> names;          ///< As the reader is to call its channels.
  std::vector<std::vector<float>> states;  ///< Time, then the values in the order of the names.
};

/// What a deck asks for. Defaults: nothing but the groups that a test adds.
struct RadiossT01Deck {
  int format = 3040;
  std::size_t title_length = 40;
  std::vector<float> units;  ///< Mass, length, time, for files that say them (from format 3050 on).
  int globals = 0;
  struct Entities {
    std::string title;
    int kind = 0;
    std::vector<std::string> names;
    std::vector<int> codes;
    std::vector<std::string> variables;  ///< Names that belong to the codes.
  };
  std::vector<Entities> parts, subsets;  ///< Each with one name.
  std::vector<Entities> groups;
};

namespace detail {
inline void add_names(const RadiossT01Deck::Entities& entities, std::vector<std::string>& names) {
  for (const std::string& name : entities.names)
    for (const std::string& variable : entities.variables) names.push_back(name + "_" + variable);
}

inline std::string part_records(const RadiossT01Deck& deck, RadiossT01File& file) {
  std::string bytes;
  int id = 0;
  for (const auto& part : deck.parts) {
    const int variables = static_cast<int>(part.codes.size());
    bytes += fortran_record(word(++id) + padded(part.names.front(), deck.title_length) + words({0, 1, 2, variables}));
    if (variables > 0) bytes += fortran_record(words(part.codes));
    add_names(part, file.names);
  }
  bytes += fortran_record(word(7) + padded("steel", deck.title_length));  // the one material
  return bytes;
}

inline std::string subset_records(const RadiossT01Deck& deck, RadiossT01File& file) {
  std::string bytes;
  int id = 0;
  for (const auto& subset : deck.subsets) {
    const int variables = static_cast<int>(subset.codes.size());
    bytes += fortran_record(words({++id, 0, 1, 2, variables}) + padded(subset.names.front(), deck.title_length));
    bytes += fortran_record(words({9})) + fortran_record(words({1, 2}));
    if (variables > 0) bytes += fortran_record(words(subset.codes));
    add_names(subset, file.names);
  }
  return bytes;
}

inline std::string group_records(const RadiossT01Deck& deck, RadiossT01File& file) {
  std::string bytes;
  int id = 0;
  for (const auto& group : deck.groups) {
    const int count = static_cast<int>(group.names.size()), variables = static_cast<int>(group.codes.size());
    bytes += fortran_record(words({++id, group.kind, 0, count, variables}) + padded(group.title, deck.title_length));
    int entity = 0;
    for (const std::string& name : group.names)
      bytes += fortran_record(word(100 + entity++) + padded(name, deck.title_length));
    if (variables > 0) bytes += fortran_record(words(group.codes));
    add_names(group, file.names);
  }
  return bytes;
}

/// How many values each record of a state has, time first.
inline std::vector<std::size_t> record_sizes(const RadiossT01Deck& deck) {
  std::vector<std::size_t> sizes = {1, static_cast<std::size_t>(deck.globals), 0, 0};
  for (const auto& part : deck.parts) sizes[2] += part.codes.size();
  for (const auto& subset : deck.subsets) sizes[3] += subset.codes.size();
  for (const auto& group : deck.groups) sizes.push_back(group.names.size() * group.codes.size());
  std::erase(sizes, std::size_t{0});
  return sizes;
}
}  // namespace detail

/// The header of a file, no states yet.
inline RadiossT01File radioss_t01_header(const RadiossT01Deck& deck) {
  RadiossT01File file;
  file.bytes = fortran_record(word(deck.format) + padded("a run  of the car", 80)) +
               fortran_record(padded("Sun Nov 22 09:14:56 2026 RADIOSS OpenRadioss,   linux64", 80));
  if (!deck.units.empty())
    file.bytes += fortran_record(word(2)) + fortran_record(word(static_cast<int>(deck.title_length))) +
                  fortran_record(word(deck.units[0]) + word(deck.units[1]) + word(deck.units[2]));
  const auto count = [](const auto& list) { return static_cast<int>(list.size()); };
  file.bytes += fortran_record(words({count(deck.parts), 1, 0, count(deck.subsets), count(deck.groups), deck.globals}));
  std::vector<int> codes;
  constexpr const char* kGlobal[] = {"INTERNAL ENERGY", "KINETIC ENERGY", "X-MOMENTUM", "Y-MOMENTUM", "Z-MOMENTUM"};
  for (int i = 0; i < deck.globals; ++i) {
    codes.push_back(i + 1);
    file.names.push_back(kGlobal[i]);
  }
  if (deck.globals > 0) file.bytes += fortran_record(words(codes));
  file.bytes += detail::part_records(deck, file);
  file.bytes += detail::subset_records(deck, file);
  file.bytes += detail::group_records(deck, file);
  file.header_bytes = file.bytes.size();
  return file;
}

/// Adds a state. @param values time first
inline void add_state(const RadiossT01Deck& deck, const std::vector<float>& values, RadiossT01File& file) {
  const std::size_t before = file.bytes.size();
  std::size_t next = 0;
  for (const std::size_t size : detail::record_sizes(deck)) {
    std::string payload;
    for (std::size_t i = 0; i < size; ++i) payload += word(values.at(next++));
    file.bytes += fortran_record(payload);
  }
  file.state_bytes = file.bytes.size() - before;
  file.states.push_back(values);
}

/// A deck of any layout.
inline RadiossT01Deck random_radioss_t01_deck(Random& random) {
  RadiossT01Deck deck;
  const int version = random.whole(0, 2);
  deck.format = std::vector<int>{3040, 3041, 4021}[static_cast<std::size_t>(version)];
  deck.title_length = std::vector<std::size_t>{40, 80, 100}[static_cast<std::size_t>(version)];
  if (version == 2) deck.units = {1.0F, 1.0F, 1.0F};
  deck.globals = random.whole(0, 5);
  for (int i = random.whole(0, 3); i-- > 0;)
    deck.parts.push_back(random.whole(0, 1) == 0
                             ? RadiossT01Deck::Entities{"", 0, {fmt::format("part{}", i)}, {}, {}}
                             : RadiossT01Deck::Entities{"", 0, {fmt::format("part{}", i)}, {2, 1}, {"KE", "IE"}});
  for (int i = random.whole(0, 2); i-- > 0;)
    deck.subsets.push_back({"", 0, {fmt::format("subset {}", i)}, {6, 26}, {"MASS", "var2"}});
  const RadiossT01Deck::Entities kinds[] = {{"nodes", 0, {}, {4, 9, 10}, {"VX", "AZ", "VRX"}},
                                            {"TH RWALL", 102, {}, {1, 2, 6}, {"FNX", "FNY", "FTZ"}},
                                            {"sensors", 108, {}, {3}, {"AZ"}},
                                            {"others", 9999, {}, {1, 7}, {"var1", "var2"}}};
  for (int i = random.whole(0, 4); i-- > 0;) {
    deck.groups.push_back(kinds[random.whole(0, 3)]);
    for (int j = random.whole(0, 5); j-- > 0;) deck.groups.back().names.push_back(fmt::format("E{}_{}", i, j));
  }
  return deck;
}

/// A file of any layout with random values at increasing times.
inline RadiossT01File random_radioss_t01_file(Random& random) {
  const RadiossT01Deck deck = random_radioss_t01_deck(random);
  RadiossT01File file = radioss_t01_header(deck);
  const int states = random.whole(1, 150);
  for (int state = 0; state < states; ++state) {
    std::vector<float> values = {static_cast<float>(state) * 1e-4F};
    for (std::size_t i = 0; i < file.names.size(); ++i)
      values.push_back(static_cast<float>(random.between(-50.0, 50.0)));
    add_state(deck, values, file);
  }
  return file;
}

}  // namespace crashsim::test
