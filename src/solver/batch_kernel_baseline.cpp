#include "solver/batch_kernel_body.hpp"

namespace crashsim {

const BatchKernel kBatchKernelBaseline = kKernel<2>;

}  // namespace crashsim
