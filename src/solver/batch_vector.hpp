#pragma once
/// The N_Vector of many motions in one CVODE problem: a small vector with the batch kernel's operations.

#include "instruction_set.hpp"
#include "solver/cvode.hpp"

namespace crashsim {

/// Makes vectors of kBatchLength zeros whose hot operations use this instruction set.
Cvode::NewVector new_batch_vector(InstructionSet set);

}  // namespace crashsim
