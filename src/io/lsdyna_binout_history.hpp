#pragma once
/// The states of a binout's databases as histories with increasing times, and the values of their variables.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/lsdyna_binout_index.hpp"

namespace crashsim::io {

/// States of a branch that make one history, in the order of their times. Where a restarted run has written a time
/// again, its state takes the place of the earlier ones from that time on. Says in `warnings` what is left out.
std::vector<std::uint32_t> history_of(const BinoutBranch& branch, std::vector<std::string>& warnings);

/// Where the values of one state are.
struct BinoutRecord {
  const char* record = nullptr;
  std::uint32_t state = 0, file = 0;
};

/// Records of a series in the states of a history.
std::vector<BinoutRecord> records_of(const BinoutSeries& series, std::span<const std::uint32_t> history);

/// One value of each record, in SI units.
struct BinoutColumn {
  std::size_t index = 0;      ///< Among the values of a state.
  double* samples = nullptr;  ///< Room for as many as there are records.
};

/// Reads columns, ascending by index, of a series.
void read_columns(std::span<const BinoutRecord> records, const BinoutIndex& index, double to_si,
                  std::span<const BinoutColumn> columns);

}  // namespace crashsim::io
