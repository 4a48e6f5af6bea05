#include "folder_command.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "interrupt.hpp"

namespace crashsim::cli {

namespace fs = std::filesystem;

void FolderCommand::check_folder(const std::vector<std::string>& names, const std::vector<std::string>& inputs) const {
  if (output() == "-") throw InvalidInput("-o -: a case writes several files: name a folder");
  if (output().empty()) return check_output({});
  if (fs::exists(output()) && !fs::is_directory(output()))
    throw InvalidInput(fmt::format("{}: is a file: name a folder for the outputs of the case", output()));
  if (!fs::exists(output())) return;
  for (const std::string& name : names) check_writable(path_of(name), inputs);
}

void FolderCommand::write_files(const std::vector<FileText>& files) const {
  if (output().empty()) return;
  const CooperativeInterrupt finish_first;
  std::error_code error;
  fs::create_directories(output(), error);
  if (error) throw SystemFailure(fmt::format("{}: cannot be made: {}", output(), error.message()));
  for (const FileText& file : files) write_file_atomically(path_of(file.name), file.text, overwrite());
}

std::string FolderCommand::path_of(const std::string& name) const { return (fs::path(output()) / name).string(); }

}  // namespace crashsim::cli
