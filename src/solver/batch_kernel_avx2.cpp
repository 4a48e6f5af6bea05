#include "solver/batch_kernel_body.hpp"

namespace crashsim {

const BatchKernel kBatchKernelAvx2 = kKernel<4>;

}  // namespace crashsim
