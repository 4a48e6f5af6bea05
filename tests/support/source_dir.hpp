#pragma once
/// Where the sources are. A function, not a macro: compiled objects then do not depend on it and checkouts share them.

namespace crashsim::test {

/// Absolute path of the source tree.
const char* source_dir();

}  // namespace crashsim::test
