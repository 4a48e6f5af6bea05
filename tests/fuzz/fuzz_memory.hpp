#pragma once
/// The memory that reading a file may hold: four times its size and 64 MB more.

#include <cstddef>

namespace crashsim::fuzz {

/// From its construction to its end the program aborts when what it has allocated meanwhile exceeds the limit.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::size_t file_size);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;
};

}  // namespace crashsim::fuzz
