#pragma once
/// Where the files of an ISO-MME test are: TEST.mme, and in its folder Channel TEST.chn, TEST.001 and so on.

#include <map>
#include <string>

#include "io/iso_mme_header.hpp"

namespace crashsim::io {

struct IsoMmeFiles {
  std::string test, list;               ///< TEST.mme and TEST.chn, "" where there is none.
  std::map<int, std::string> channels;  ///< By their numbers.
  std::string only;                     ///< The channel file that was named, "" when all are meant.
};

/// Whether a folder is, or is the Channel folder of, a test.
bool is_iso_mme_folder(const std::string& path);

/// The files that belong together with a file or folder, whatever the case of their names and whether or not the
/// channels have a folder of their own. @throws InvalidInput when a folder has several tests.
IsoMmeFiles find_iso_mme_files(const std::string& path, bool is_folder, IsoMmeFile kind);

}  // namespace crashsim::io
