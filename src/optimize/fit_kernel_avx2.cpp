#include "optimize/fit_kernel_body.hpp"

namespace crashsim {

const FitKernel kFitKernelAvx2 = kKernel<4>;

}  // namespace crashsim
