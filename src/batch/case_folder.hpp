#pragma once
/// Where the files of a case stand in the folder of a batch.

#include <string>
#include <vector>

#include <crashsim/files.hpp>

#include "batch/folder.hpp"

namespace crashsim::batch {

inline constexpr const char* kCases = "cases";     ///< A folder each.
inline constexpr const char* kPrivate = ".batch";  ///< Journal, lock, what is half done.
inline constexpr const char* kHalfDone = "tmp";    ///< In kPrivate.

inline constexpr const char* kCaseRecord = "case.lock.json";

/// Puts the files of a case in the place of earlier ones, whole or not at all.
/// @throws SystemFailure when they cannot be written, InvalidInput when the folder holds what is none of crashsim's.
void put_case_files(const Folder& batch, const std::string& name, const std::vector<FileText>& files);

/// Removes them, and what of the case is half done. @throws as put_case_files().
void remove_case_files(const Folder& batch, const std::string& name);

/// Bytes of the files of a case; 0 when there are none.
std::uint64_t case_bytes(const Folder& batch, const std::string& name);

}  // namespace crashsim::batch
