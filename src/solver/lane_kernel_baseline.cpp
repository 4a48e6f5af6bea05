#include "solver/lane_kernel_body.hpp"

namespace crashsim {

const LaneKernel kLaneKernelBaseline = kKernel<2>;

}  // namespace crashsim
