#pragma once
/// Which channels of a file are cells of a load-cell wall, and which of them can be used.

#include <optional>
#include <string>
#include <vector>

#include <crashsim/load_cell_wall.hpp>
#include <crashsim/trace.hpp>

namespace crashsim {

/// A cell, or the sum of a row (column 0).
struct WallCell {
  int row = 0, column = 0;   ///< From 1; row A is 1.
  std::size_t trace = 0;     ///< Index in the set.
  bool is_lettered = false;  ///< "LCA1": the older walls, whose rows have letters.
};

/// All cells that a file describes, good or not; else its row sums. @throws InvalidInput when there are none, or a row
/// named in the options does not exist.
std::vector<WallCell> find_cells(const TraceSet& set, const WallOptions& options);

/// "K-01", or "row K" of a row sum.
std::string cell_name(const WallCell& cell);

/// Lower-case letter of a row, its number beyond z.
std::string row_name(int row);

/// The cells that can be used, and the others with the reason.
struct CellChoice {
  std::vector<WallCell> used;
  std::vector<std::string> excluded;
};
CellChoice choose_cells(const TraceSet& set, const std::vector<WallCell>& cells);

}  // namespace crashsim
