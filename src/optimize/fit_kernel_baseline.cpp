#include "optimize/fit_kernel_body.hpp"

namespace crashsim {

const FitKernel kFitKernelBaseline = kKernel<2>;

}  // namespace crashsim
