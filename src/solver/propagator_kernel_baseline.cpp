#include "solver/propagator_kernel_body.hpp"

namespace crashsim {

const PropagatorKernel kPropagatorKernelBaseline = kKernel<2>;

}  // namespace crashsim
