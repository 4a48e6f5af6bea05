# Warnings for our own targets: crashsim_warnings.
add_library(crashsim_warnings INTERFACE)
target_compile_options(crashsim_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                                                   -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")  # std::stable_sort of libstdc++ 12 calls what it deprecates itself
  target_compile_options(crashsim_warnings INTERFACE -Wno-deprecated-declarations)
endif()
if(CRASHSIM_WERROR)
  target_compile_options(crashsim_warnings INTERFACE -Werror)
endif()
