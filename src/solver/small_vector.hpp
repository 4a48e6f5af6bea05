#pragma once
/// An N_Vector for systems of a few unknowns: contiguous, serial, every operation inlined by our own compiler flags.
/// The packaged one spends most of a run of two unknowns in bookkeeping.

#include "solver/sundials_compat.hpp"

namespace crashsim {

/// New vector of `length` zeros, which start at a multiple of 64 bytes; free it with N_VDestroy(). nullptr when there
/// is no memory. Clones have the operations of the original.
N_Vector new_small_vector(sunindextype length, SUNContext context);

/// What such a vector's `content` points to: the length, then the numbers in the same block of memory.
struct alignas(64) SmallVectorContent {
  sunindextype length;

  sunrealtype* data() { return reinterpret_cast<sunrealtype*>(this + 1); }
};
inline sunrealtype* small_vector_data(N_Vector v) { return static_cast<SmallVectorContent*>(v->content)->data(); }

}  // namespace crashsim
