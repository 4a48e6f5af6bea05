#include "solver/batch_vector.hpp"

#include <array>
#include <cmath>

#include "solver/batch_kernel.hpp"

namespace crashsim {
namespace {

constexpr std::size_t kMostVectors = 16;  // more than an Adams method has
using Pointers = std::array<sunrealtype*, kMostVectors>;

Pointers pointers(int count, N_Vector* vectors) {
  Pointers all{};
  for (int k = 0; k < count; ++k) all[static_cast<std::size_t>(k)] = small_vector_data(vectors[k]);
  return all;
}

template <const BatchKernel& kernel>
struct Operations {
  static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z) {
    kernel.linear_sum(a, small_vector_data(x), b, small_vector_data(y), small_vector_data(z));
  }
  static void scale(sunrealtype c, N_Vector x, N_Vector z) {
    kernel.scale(c, small_vector_data(x), small_vector_data(z));
  }
  static int linear_combination(int count, sunrealtype* c, N_Vector* x, N_Vector z) {
    kernel.linear_combination(count, c, pointers(count, x).data(), small_vector_data(z));
    return 0;
  }
  static int scale_add_multi(int count, sunrealtype* a, N_Vector x, N_Vector* y, N_Vector* z) {
    kernel.scale_add(count, a, small_vector_data(x), pointers(count, y).data(), pointers(count, z).data());
    return 0;
  }
  static sunrealtype wrms_norm(N_Vector x, N_Vector w) {
    const double sum = kernel.weighted_square(small_vector_data(x), small_vector_data(w));
    return std::sqrt(sum / static_cast<double>(kBatchLength));
  }

  static N_Vector make(sunindextype length, SUNContext context) {
    N_Vector v = new_small_vector(length, context);
    if (v == nullptr) return nullptr;
    v->ops->nvlinearsum = linear_sum;
    v->ops->nvscale = scale;
    v->ops->nvlinearcombination = linear_combination;
    v->ops->nvscaleaddmulti = scale_add_multi;
    v->ops->nvwrmsnorm = wrms_norm;
    return v;
  }
};

}  // namespace

Cvode::NewVector new_batch_vector(InstructionSet set) {
  if (set == InstructionSet::avx512) return Operations<kBatchKernelAvx512>::make;
  return set == InstructionSet::avx2 ? Operations<kBatchKernelAvx2>::make : Operations<kBatchKernelBaseline>::make;
}

}  // namespace crashsim
