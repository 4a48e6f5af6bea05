#include "solver/propagator_kernel_body.hpp"

namespace crashsim {

const PropagatorKernel kPropagatorKernelAvx512 = kKernel<4>;

}  // namespace crashsim
