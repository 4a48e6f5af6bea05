#pragma once
/// The folder of a batch: what is done is kept there, and told after any end.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crashsim/batch.hpp>

namespace crashsim {

/// Owns the folder of a batch while it lives: nobody else can open it. For run_batch() and for other ways to run the
/// cases of a batch: run_batch_case() anywhere, then record() here.
class BatchFolder {
 public:
  /// Makes the folder or, with `options.resume`, goes on in it; clears what a killed batch left half done.
  /// @throws InvalidInput when a name is no single one or there twice, or the folder holds results (without `resume`),
  /// other things or another shard, or is in use;
  ///         SystemFailure when it cannot be written.
  BatchFolder(const std::string& path, const std::vector<BatchCase>& plan, const BatchOptions& options);
  ~BatchFolder();
  BatchFolder(const BatchFolder&) = delete;
  BatchFolder& operator=(const BatchFolder&) = delete;

  [[nodiscard]] const std::string& path() const;
  /// The cases of this shard, in the order of the plan.
  [[nodiscard]] const std::vector<BatchCase>& cases() const;
  /// The row of a case from an earlier run or this one.
  [[nodiscard]] std::optional<BatchRow> row_of(std::size_t index) const;
  /// Cases with a row that are none of cases().
  [[nodiscard]] std::size_t left_over() const;

  /// Keeps a row: from now on the case is done, whatever happens. Removes the files of a case without results.
  /// @throws SystemFailure when it cannot be written.
  void record(std::size_t index, const BatchRow& row);

  /// Writes results.csv, results.jsonl and timings.csv of the rows there are, also of an earlier run.
  /// @param of a flag for each of cases(): rows of these only, as when a run was stopped that has not looked whether
  ///        the others still hold; empty: all. @throws SystemFailure
  void write_tables(const std::vector<bool>& of = {}) const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace crashsim
