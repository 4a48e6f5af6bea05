#pragma once
/// An N_Vector for systems of a few unknowns: contiguous, serial, every operation inlined by our own compiler flags.
/// The packaged one spends most of a run of two unknowns in bookkeeping.

#include "solver/sundials_compat.hpp"

namespace crashsim {

/// New vector of `length` zeros; free it with N_VDestroy(). nullptr when there is no memory.
N_Vector new_small_vector(sunindextype length, SUNContext context);

}  // namespace crashsim
