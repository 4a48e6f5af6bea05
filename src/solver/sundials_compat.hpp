#pragma once
/// What differs between SUNDIALS 6 and 7, in one place.

#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_nvector.h>

namespace crashsim::sundials {

#if SUNDIALS_VERSION_MAJOR >= 7
using Boolean = sunbooleantype;
inline int create_context(SUNContext* context) { return SUNContext_Create(SUN_COMM_NULL, context); }
#else
using Boolean = booleantype;
inline int create_context(SUNContext* context) { return SUNContext_Create(nullptr, context); }
#endif

}  // namespace crashsim::sundials
