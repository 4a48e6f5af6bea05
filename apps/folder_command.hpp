#pragma once
/// A command that writes several files into a folder.

#include <string>
#include <vector>

#include "command.hpp"

namespace crashsim::cli {

class FolderCommand : public Command {
 public:
  using Command::Command;

 protected:
  /// Refuses, before any work is done, a folder that is a file or holds one of these names (without --overwrite).
  void check_folder(const std::vector<std::string>& names, const std::vector<std::string>& inputs) const;
  /// Writes them, if an output was asked for.
  void write_files(const std::vector<FileText>& files) const;

 private:
  [[nodiscard]] std::string path_of(const std::string& name) const;
};

}  // namespace crashsim::cli
