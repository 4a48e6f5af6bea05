#include <crashsim/files.hpp>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <unistd.h>

#include <fmt/format.h>
#include <openssl/evp.h>

#include <crashsim/error.hpp>

#include "io/input_file.hpp"

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

void write_beside_and_rename(const std::string& path, std::string_view text) {
  static std::atomic<unsigned> counter{0};
  const std::string target = fs::is_symlink(path) ? fs::weakly_canonical(path).string() : path;
  const std::string beside = fmt::format("{}.{}-{}.part", target, ::getpid(), counter++);
  std::FILE* file = std::fopen(beside.c_str(), "wbx");
  if (file == nullptr) cannot_write(path, errno);
  int error = write_and_close(file, text);
  if (error == 0 && std::rename(beside.c_str(), target.c_str()) != 0) error = errno;
  if (error == 0) return;
  std::remove(beside.c_str());
  cannot_write(path, error);
}

}  // namespace

std::string read_file(const std::string& path) { return std::string(bytes_of(io::InputFile(path))); }

std::string sha256_of_file(const std::string& path) {
  const io::InputFile file(path);
  const std::string_view bytes = bytes_of(file);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
    throw SystemFailure(fmt::format("{}: SHA-256 failed", path));
  std::string hex;
  for (unsigned i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

void write_file_atomically(const std::string& path, std::string_view text, bool overwrite) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw InvalidInput(fmt::format("{}: is a folder: name a file to write", path));
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_directly(path, text);
  if (fs::exists(status) && !overwrite)
    throw InvalidInput(fmt::format("{}: exists already: choose another name", path));
  write_beside_and_rename(path, text);
}

void write_output(const std::string& path, std::string_view text, bool overwrite) {
  if (path != "-") return write_file_atomically(path, text, overwrite);
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    cannot_write("standard output", errno);
}

}  // namespace crashsim
