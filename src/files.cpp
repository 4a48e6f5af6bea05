#include <crashsim/files.hpp>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <unistd.h>

#include <fmt/format.h>

#include <crashsim/error.hpp>

#include "io/input_file.hpp"
#include "sha256.hpp"

namespace crashsim {
namespace {

namespace fs = std::filesystem;

std::string_view bytes_of(const io::InputFile& file) {
  if (file.is_folder()) throw InvalidInput(fmt::format("{}: is a folder, not a file", file.path()));
  return file.bytes();
}

[[noreturn]] void cannot_write(const std::string& path, int error) {
  throw SystemFailure(fmt::format("{}: cannot be written: {}", path, std::strerror(error)));
}

/// Writes `text` to a C stream and closes it; 0 or the error number.
int write_and_close(std::FILE* file, std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const int write_error = errno;
  const bool closed = std::fclose(file) == 0;
  if (written && closed) return 0;
  return written ? errno : write_error;
}

void write_directly(const std::string& path, std::string_view text) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) cannot_write(path, errno);
  if (const int error = write_and_close(file, text)) cannot_write(path, error);
}

/// A name beside `target` that nobody else uses.
std::string name_beside(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return fmt::format("{}.{}-{}.part", target, ::getpid(), counter++);
}

void write_beside_and_rename(const std::string& path, std::string_view text) {
  const std::string target = fs::is_symlink(path) ? fs::weakly_canonical(path).string() : path;
  const std::string beside = name_beside(target);
  std::FILE* file = std::fopen(beside.c_str(), "wbx");
  if (file == nullptr) cannot_write(path, errno);
  int error = write_and_close(file, text);
  if (error == 0 && std::rename(beside.c_str(), target.c_str()) != 0) error = errno;
  if (error == 0) return;
  std::remove(beside.c_str());
  cannot_write(path, error);
}

/// Refuses to replace a folder that holds more than what is written anew.
void check_replaceable(const fs::path& folder, const std::vector<FileText>& files, bool overwrite) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw InvalidInput(fmt::format("{}: is a file: name a folder", folder.string()));
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!overwrite)
      throw InvalidInput(fmt::format("{}: exists already and is not empty: choose another name", folder.string()));
    const std::string name = entry.path().lexically_relative(folder).generic_string();
    const bool is_written = std::any_of(files.begin(), files.end(), [&](const FileText& file) {
      return file.name == name || (entry.is_directory() && file.name.starts_with(name + "/"));
    });
    if (!is_written)
      throw InvalidInput(
          fmt::format("{}: holds {} too, which would be lost: choose another folder", folder.string(), name));
  }
}

void write_files_into(const fs::path& folder, const std::vector<FileText>& files) {
  for (const FileText& file : files) {
    const fs::path path = folder / file.name;
    fs::create_directories(path.parent_path());
    write_directly(path.string(), file.text);
  }
}

/// Puts `made` in the place of `folder`, which goes away, or stays when that fails.
void exchange(const fs::path& made, const fs::path& folder) {
  if (!fs::exists(folder)) return fs::rename(made, folder);
  const fs::path old = name_beside(folder.string());
  fs::rename(folder, old);
  try {
    fs::rename(made, folder);
  } catch (const fs::filesystem_error&) {
    fs::rename(old, folder);
    throw;
  }
  fs::remove_all(old);
}

}  // namespace

std::string read_file(const std::string& path) { return std::string(bytes_of(io::InputFile(path))); }

std::string sha256_of_file(const std::string& path) { return sha256_of(bytes_of(io::InputFile(path))); }

void write_file_atomically(const std::string& path, std::string_view text, bool overwrite) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw InvalidInput(fmt::format("{}: is a folder: name a file to write", path));
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_directly(path, text);
  if (fs::exists(status) && !overwrite)
    throw InvalidInput(fmt::format("{}: exists already: choose another name", path));
  write_beside_and_rename(path, text);
}

void write_folder_atomically(const std::string& path, const std::vector<FileText>& files, bool overwrite) {
  fs::path folder = fs::path(path).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  if (path.empty() || folder == "." || folder == "..")
    throw InvalidInput(fmt::format("'{}': name a folder to be made", path));
  const fs::path beside = name_beside(folder.string());
  try {
    check_replaceable(folder, files, overwrite);
    write_files_into(beside, files);
    exchange(beside, folder);
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove_all(beside, ignored);
    cannot_write(path, error.code().value());
  } catch (const SystemFailure&) {
    std::error_code ignored;
    fs::remove_all(beside, ignored);
    throw;
  }
}

void write_output(const std::string& path, std::string_view text, bool overwrite) {
  if (path != "-") return write_file_atomically(path, text, overwrite);
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    cannot_write("standard output", errno);
}

}  // namespace crashsim
