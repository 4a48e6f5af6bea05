#include "solver/propagator_kernel_body.hpp"

namespace crashsim {

const PropagatorKernel kPropagatorKernelAvx2 = kKernel<4>;

}  // namespace crashsim
