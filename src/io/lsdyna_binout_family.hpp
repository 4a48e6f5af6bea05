#pragma once
/// The files of one LS-DYNA run: which belong together, by their names.

#include <string>
#include <vector>

namespace crashsim::io {

/// Files beside a binout that belong to its run, itself included, in the order in which they were written, and what is
/// missing among them.
///
/// `binout0000%001`, `%002` and so on continue `binout0000` when that has become long, `binout0000_` does after a
/// restart of older versions. `binout0003` is what the fourth process of a parallel run writes: each database is in the
/// file of one process, so their numbers have gaps. Files of other names have only continuations.
struct BinoutFamily {
  std::vector<std::string> paths;
  std::vector<std::string> warnings;
};
BinoutFamily binout_family(const std::string& path);

}  // namespace crashsim::io
