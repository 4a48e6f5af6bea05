#include "solver/lane_kernel_body.hpp"

namespace crashsim {

const LaneKernel kLaneKernelAvx512 = kKernel<8>;

}  // namespace crashsim
