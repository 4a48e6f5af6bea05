#include "optimize/fit_kernel_body.hpp"

namespace crashsim {

const FitKernel kFitKernelAvx512 = kKernel<PolynomialLaw, 8>;

}  // namespace crashsim
