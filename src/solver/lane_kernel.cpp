#include "solver/lane_kernel.hpp"

namespace crashsim {

#if defined(CRASHSIM_X86_KERNELS)

bool is_available(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2");
    case InstructionSet::baseline:
      return true;
  }
  return false;
}

const LaneKernel& lane_kernel(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return kLaneKernelAvx512;
    case InstructionSet::avx2:
      return kLaneKernelAvx2;
    case InstructionSet::baseline:
      break;
  }
  return kLaneKernelBaseline;
}

#else

bool is_available(InstructionSet set) { return set == InstructionSet::baseline; }
const LaneKernel& lane_kernel(InstructionSet) { return kLaneKernelBaseline; }

#endif

InstructionSet widest_instruction_set() {
  if (is_available(InstructionSet::avx512)) return InstructionSet::avx512;
  return is_available(InstructionSet::avx2) ? InstructionSet::avx2 : InstructionSet::baseline;
}

}  // namespace crashsim
