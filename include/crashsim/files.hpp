#pragma once
/// Whole files: read, written all or nothing, and their fingerprints.

#include <string>
#include <string_view>
#include <vector>

namespace crashsim {

/// The bytes of a file. @throws InvalidInput with the path and the reason when it is missing, a folder or unreadable.
std::string read_file(const std::string& path);

/// SHA-256 of a file's bytes as 64 hexadecimal digits. @throws InvalidInput as read_file().
std::string sha256_of_file(const std::string& path);

/// Writes a file so that it appears whole or not at all: beside it first, then renamed. A symbolic link keeps pointing
/// where it did; a device or pipe is written directly.
/// @throws InvalidInput when the file exists and `overwrite` is false, SystemFailure with path and reason when it
///         cannot be written.
void write_file_atomically(const std::string& path, std::string_view text, bool overwrite);

/// A file to be written into a folder.
struct FileText {
  std::string name;  ///< Relative to the folder, with `/` before which are folders in it.
  std::string text;
};

/// Writes a folder so that it appears with all its files or not at all: beside it first, then renamed.
/// @throws InvalidInput when it exists and is not empty, unless `overwrite` is true and it holds nothing but what is
///         written anew; SystemFailure with path and reason when it cannot be written.
void write_folder_atomically(const std::string& path, const std::vector<FileText>& files, bool overwrite);

/// Writes to a file as write_file_atomically(), or to standard output when `path` is "-".
void write_output(const std::string& path, std::string_view text, bool overwrite);

}  // namespace crashsim
