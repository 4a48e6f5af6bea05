#include "fuzz_memory.hpp"

#include <atomic>
#include <cstdio>
#include <cstdlib>

#include <sanitizer/allocator_interface.h>

namespace crashsim::fuzz {
namespace {

constexpr std::size_t kTimesSize = 4, kBeyond = std::size_t{64} << 20;

std::atomic<std::size_t> limit{0};  // of what the allocator has given out; 0: none

void on_allocation(const volatile void*, std::size_t size) {
  const std::size_t most = limit.load(std::memory_order_relaxed);
  if (most == 0 || __sanitizer_get_current_allocated_bytes() + size <= most) return;
  limit.store(0);
  std::fprintf(stderr, "memory limit: an allocation of %zu bytes goes beyond it\n", size);
  std::abort();
}

void on_release(const volatile void*) {}

}  // namespace

MemoryLimit::MemoryLimit(std::size_t file_size) {
  static const int installed = __sanitizer_install_malloc_and_free_hooks(on_allocation, on_release);
  if (installed == 0) std::abort();
  limit = __sanitizer_get_current_allocated_bytes() + kTimesSize * file_size + kBeyond;
}

MemoryLimit::~MemoryLimit() { limit = 0; }

}  // namespace crashsim::fuzz
