#pragma once
/// Which vector instructions the inner loops use. They are compiled for each set in files of their own, which include
/// nothing that defines an inline function: the linker might take its copy, made for instructions that the processor
/// does not have, for all.

namespace crashsim {

enum class InstructionSet { baseline, avx2, avx512 };

/// Whether this processor has it.
bool is_available(InstructionSet set);
/// The widest available.
InstructionSet widest_instruction_set();

/// One kernel compiled for each set.
template <class Kernel>
struct KernelChoice {
  const Kernel &baseline, &avx2, &avx512;

  /// @param set an available one.
  [[nodiscard]] const Kernel& operator()(InstructionSet set) const {
    if (set == InstructionSet::avx512) return avx512;
    return set == InstructionSet::avx2 ? avx2 : baseline;
  }
};

}  // namespace crashsim
