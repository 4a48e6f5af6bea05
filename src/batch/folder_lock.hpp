#pragma once
/// Who works in a folder: one at a time.

#include <string>

#include "batch/folder.hpp"

namespace crashsim::batch {

/// Holds a folder's lock while it lives; when its process is killed, until those that it forked are gone, too.
class FolderLock {
 public:
  /// @param what of the folder, for messages: its path.
  /// @throws InvalidInput naming process and host that hold it.
  FolderLock(const Folder& folder, const std::string& what);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int fd_;
};

}  // namespace crashsim::batch
