#pragma once
/// An ISO-MME test described, without samples.

#include <string>
#include <vector>

#include <crashsim/trace.hpp>

#include "io/input_file.hpp"
#include "io/iso_mme_files.hpp"
#include "io/iso_mme_header.hpp"

namespace crashsim::io {

struct IsoMmeChannelFile {
  int number = 0;
  std::string path;    ///< "" when it is absent.
  std::string listed;  ///< What TEST.chn says of it, "" nothing.
  IsoMmeHeader header;
};

/// A test: `set.traces[i]` describes `channels[i]`. A channel without a trace is there for its times.
struct IsoMmeCatalogue {
  std::vector<IsoMmeChannelFile> channels;
  TraceSet set;
};

/// Reads the headers of a test's files. Those of the file that was opened come from its bytes.
/// @throws InvalidInput when a header is not one, or there are no channels.
IsoMmeCatalogue catalogue_iso_mme(const InputFile& opened, const IsoMmeFiles& files);

/// Calls use(bytes) with a file's bytes: those of the file that is open already, or read for that.
template <class Use>
auto with_bytes(const InputFile& opened, const std::string& path, Use use) {
  if (path == opened.path()) return use(opened.bytes());
  const InputFile file(path);
  return use(file.bytes());
}

}  // namespace crashsim::io
