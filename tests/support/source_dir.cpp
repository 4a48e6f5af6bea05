#include "support/source_dir.hpp"

namespace crashsim::test {

const char* source_dir() { return CRASHSIM_SOURCE_DIR; }

}  // namespace crashsim::test
