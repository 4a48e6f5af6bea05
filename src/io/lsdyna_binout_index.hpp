#pragma once
/// Where each variable of a binout is: its databases, their states and, for each variable, the records of its values.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <crashsim/error.hpp>

#include "io/lsda.hpp"

namespace crashsim::io {

/// Records of a variable from `record` on belong to the states from `state` on, one each, and to one file.
struct BinoutRun {
  std::uint32_t state = 0, record = 0, file = 0;
};

/// One variable of a database over its states.
struct BinoutSeries {
  std::string name;
  std::size_t count = 0;             ///< Values a state.
  std::vector<const char*> records;  ///< Of the states that have it.
  std::vector<BinoutRun> runs;
  std::size_t misfits = 0;  ///< States with another count, which are left out.
};

/// A constant of a database, from its directory "metadata".
struct BinoutConstant {
  LsdaVariable variable;
  LsdaLayout layout;
  [[nodiscard]] std::vector<double> numbers() const;
  /// Text without the blanks that fill it.
  [[nodiscard]] std::string text() const;
};

struct BinoutState {
  static constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();
  double time = kUnset;         ///< As in the file; NaN when it has none.
  std::uint32_t number = 0;     ///< By its directory: 7 of "d000007"; kDropped when it is incomplete.
  std::uint32_t variables = 0;  ///< How many it holds.
};

/// A directory with states, as "/nodout" or "/rwforc/forces".
struct BinoutBranch {
  std::string path;                 ///< Without the first slash.
  std::vector<BinoutState> states;  ///< In the order in which they were written.
  std::deque<BinoutSeries> series;
  std::unordered_map<std::string_view, std::size_t> series_by_name;
  std::map<std::string, BinoutConstant, std::less<>> constants;
  std::size_t ids_change = std::numeric_limits<std::size_t>::max();  ///< The first state with other entities.
  std::size_t next_series = 0;                                       ///< The one that probably comes next.
  std::size_t files = 0;                                             ///< Number of the file that wrote last, from 1.
  bool open = false;                                                 ///< Whether the last state may still grow.
};

/// Built from the files of a run, one after the other.
class BinoutIndex {
 public:
  BinoutIndex() = default;
  ~BinoutIndex() = default;
  BinoutIndex(const BinoutIndex&) = delete;
  BinoutIndex& operator=(const BinoutIndex&) = delete;

  /// Adds a file's variables. Its bytes must stay where they are. @throws InvalidInput when it is no LSDA file.
  void add(const InputFile& file);

  [[nodiscard]] const std::deque<BinoutBranch>& branches() const { return branches_; }
  [[nodiscard]] const LsdaLayout& layout(std::uint32_t file) const { return layouts_[file]; }
  /// What was lost of the files so far.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void enter(const std::string& directory);
  BinoutBranch* find_branch(std::string_view path);
  void add_constant(const LsdaScanner& scanner);
  void add_to_state(const LsdaScanner& scanner);
  void begin_state();
  void compare_title(const LsdaScanner& scanner);
  BinoutSeries* find_series(const LsdaVariable& variable);
  void append(BinoutSeries& series, const LsdaScanner& scanner);
  void compare_ids(const BinoutSeries& series, const LsdaScanner& scanner);
  void count_use(std::size_t bytes);
  void finish_file(const LsdaEnd& end);
  void drop_incomplete(bool open_directory, std::string& dropped);

  std::deque<BinoutBranch> branches_;
  std::unordered_map<std::string_view, std::size_t> branch_by_path_;
  std::vector<LsdaLayout> layouts_;
  std::vector<std::string> warnings_;
  std::size_t file_bytes_ = 0, used_bytes_ = 0;
  std::string title_;  // the run's, by the first database that has one
  const InputFile* file_ = nullptr;
  bool title_differs_ = false;  // in this file, and that has been said
  // The directory that is being read:
  BinoutBranch* branch_ = nullptr;  // none for directories that hold no states
  bool in_metadata_ = false;
  std::uint32_t state_number_ = 0;
};

}  // namespace crashsim::io
