# Warnings for our own targets: crashsim_warnings.
add_library(crashsim_warnings INTERFACE)
target_compile_options(crashsim_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                                                   -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual)
if(CRASHSIM_WERROR)
  target_compile_options(crashsim_warnings INTERFACE -Werror)
endif()
