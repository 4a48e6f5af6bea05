#include "solver/small_vector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

namespace crashsim {
namespace {

sunrealtype* data(N_Vector v) { return small_vector_data(v); }
sunindextype length(N_Vector v) { return static_cast<SmallVectorContent*>(v->content)->length; }

template <class Op>
void apply(N_Vector x, N_Vector z, Op op) {
  const sunrealtype* a = data(x);
  sunrealtype* c = data(z);
  for (sunindextype i = 0, n = length(z); i < n; ++i) c[i] = op(a[i]);
}

template <class Op>
void apply(N_Vector x, N_Vector y, N_Vector z, Op op) {
  const sunrealtype* a = data(x);
  const sunrealtype* b = data(y);
  sunrealtype* c = data(z);
  for (sunindextype i = 0, n = length(z); i < n; ++i) c[i] = op(a[i], b[i]);
}

template <class Op>
sunrealtype reduce(N_Vector x, N_Vector y, Op op) {
  const sunrealtype* a = data(x);
  const sunrealtype* b = data(y);
  sunrealtype sum = 0.0;
  for (sunindextype i = 0, n = length(x); i < n; ++i) sum = op(sum, a[i], b[i]);
  return sum;
}

N_Vector clone(N_Vector v) {
  N_Vector copy = new_small_vector(length(v), v->sunctx);
  if (copy != nullptr) *copy->ops = *v->ops;
  return copy;
}

void destroy(N_Vector v) {
  if (v == nullptr) return;
  std::free(v->content);
  N_VFreeEmpty(v);
}

void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z) {
  apply(x, y, z, [a, b](sunrealtype p, sunrealtype q) { return a * p + b * q; });
}
void set_constant(sunrealtype c, N_Vector z) {
  apply(z, z, [c](sunrealtype) { return c; });
}
void product(N_Vector x, N_Vector y, N_Vector z) {
  apply(x, y, z, [](sunrealtype p, sunrealtype q) { return p * q; });
}
void quotient(N_Vector x, N_Vector y, N_Vector z) {
  apply(x, y, z, [](sunrealtype p, sunrealtype q) { return p / q; });
}
void scale(sunrealtype c, N_Vector x, N_Vector z) {
  apply(x, z, [c](sunrealtype p) { return c * p; });
}
void absolute(N_Vector x, N_Vector z) {
  apply(x, z, [](sunrealtype p) { return std::fabs(p); });
}
void inverse(N_Vector x, N_Vector z) {
  apply(x, z, [](sunrealtype p) { return 1.0 / p; });
}
void add_constant(N_Vector x, sunrealtype b, N_Vector z) {
  apply(x, z, [b](sunrealtype p) { return p + b; });
}
sunrealtype dot(N_Vector x, N_Vector y) {
  return reduce(x, y, [](sunrealtype s, sunrealtype p, sunrealtype q) { return s + p * q; });
}
sunrealtype max_norm(N_Vector x) {
  return reduce(x, x, [](sunrealtype s, sunrealtype p, sunrealtype) { return std::max(s, std::fabs(p)); });
}
sunrealtype minimum(N_Vector x) { return *std::min_element(data(x), data(x) + length(x)); }
sunrealtype wrms_norm(N_Vector x, N_Vector w) {
  const auto sum = reduce(x, w, [](sunrealtype s, sunrealtype p, sunrealtype q) { return s + p * q * p * q; });
  return std::sqrt(sum / static_cast<sunrealtype>(length(x)));
}

int linear_combination(int count, sunrealtype* c, N_Vector* x, N_Vector z) {
  sunrealtype* out = data(z);
  for (sunindextype i = 0, n = length(z); i < n; ++i) {
    sunrealtype sum = 0.0;
    for (int k = 0; k < count; ++k) sum += c[k] * data(x[k])[i];
    out[i] = sum;
  }
  return 0;
}

int scale_add_multi(int count, sunrealtype* a, N_Vector x, N_Vector* y, N_Vector* z) {
  for (int k = 0; k < count; ++k) linear_sum(a[k], x, 1.0, y[k], z[k]);
  return 0;
}

}  // namespace

N_Vector new_small_vector(sunindextype length, SUNContext context) {
  constexpr std::size_t kAlignment = alignof(SmallVectorContent);
  const std::size_t size = sizeof(SmallVectorContent) + static_cast<std::size_t>(length) * sizeof(sunrealtype);
  void* block = std::aligned_alloc(kAlignment, (size + kAlignment - 1) / kAlignment * kAlignment);
  N_Vector v = block == nullptr ? nullptr : N_VNewEmpty(context);
  if (v == nullptr) {
    std::free(block);
    return nullptr;
  }
  auto* body = new (block) SmallVectorContent{length};
  std::fill_n(body->data(), length, 0.0);
  v->content = body;
  v->ops->nvgetvectorid = [](N_Vector) { return SUNDIALS_NVEC_CUSTOM; };
  v->ops->nvclone = clone;
  v->ops->nvdestroy = destroy;
  v->ops->nvgetarraypointer = data;
  v->ops->nvgetlength = crashsim::length;
  v->ops->nvlinearsum = linear_sum;
  v->ops->nvconst = set_constant;
  v->ops->nvprod = product;
  v->ops->nvdiv = quotient;
  v->ops->nvscale = scale;
  v->ops->nvabs = absolute;
  v->ops->nvinv = inverse;
  v->ops->nvaddconst = add_constant;
  v->ops->nvdotprod = dot;
  v->ops->nvmaxnorm = max_norm;
  v->ops->nvwrmsnorm = wrms_norm;
  v->ops->nvmin = minimum;
  v->ops->nvlinearcombination = linear_combination;
  v->ops->nvscaleaddmulti = scale_add_multi;
  return v;
}

}  // namespace crashsim
