#include "optimize/fit_kernel_body.hpp"

namespace crashsim {

const FitKernel kFitKernelAvx2 = kKernel<PolynomialLaw, 4>;

}  // namespace crashsim
