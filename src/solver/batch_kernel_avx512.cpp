#include "solver/batch_kernel_body.hpp"

namespace crashsim {

const BatchKernel kBatchKernelAvx512 = kKernel<8>;

}  // namespace crashsim
