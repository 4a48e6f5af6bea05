#include "optimize/fit_kernel_body.hpp"

namespace crashsim {

const FitKernel kFitKernelBaseline = kKernel<PolynomialLaw, 2>;
const FitKernel kRateFitKernel = kKernel<RateLaw, 2>;

}  // namespace crashsim
