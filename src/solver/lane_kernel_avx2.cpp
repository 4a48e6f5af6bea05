#include "solver/lane_kernel_body.hpp"

namespace crashsim {

const LaneKernel kLaneKernelAvx2 = kKernel<4>;

}  // namespace crashsim
