# Everything crashsim is built with, found in one place.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED CONFIG)  # its headers serve both ways: source and binary package are one version
find_package(nlohmann_json 3.11 REQUIRED)
find_package(tomlplusplus 3.3 REQUIRED CONFIG)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)

# toml++ header-only: nothing to link, nothing for users of the library to find.
add_library(crashsim_toml INTERFACE)
target_include_directories(crashsim_toml SYSTEM INTERFACE
  $<TARGET_PROPERTY:tomlplusplus::tomlplusplus,INTERFACE_INCLUDE_DIRECTORIES>)

# crashsim::sundials, crashsim::nlopt and crashsim::fmt: the same names whether packaged or built from source packages.
if(CRASHSIM_DEPS STREQUAL "source")
  execute_process(COMMAND ${PROJECT_SOURCE_DIR}/script/build-deps OUTPUT_VARIABLE CRASHSIM_DEPS_PREFIX
                  OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "CRASHSIM_DEPS=source: script/build-deps could not make SUNDIALS, NLopt and fmt (see above); "
                        "use -DCRASHSIM_DEPS=system for the packaged libraries")
  endif()
  message(STATUS "SUNDIALS, NLopt and fmt from ${CRASHSIM_DEPS_PREFIX}")
  set(CRASHSIM_DEPS_LIBDIR ${CRASHSIM_DEPS_PREFIX}/lib)
  include(SourceDependencies)
  target_include_directories(crashsim::sundials INTERFACE ${CRASHSIM_DEPS_PREFIX}/include)
  target_include_directories(crashsim::nlopt INTERFACE ${CRASHSIM_DEPS_PREFIX}/include)
elseif(CRASHSIM_DEPS STREQUAL "system")
  find_package(SUNDIALS REQUIRED CONFIG COMPONENTS cvodes)  # no version here: its config refuses a newer major one
  if(SUNDIALS_VERSION VERSION_LESS 6.4)
    message(FATAL_ERROR "SUNDIALS ${SUNDIALS_VERSION} in ${SUNDIALS_DIR}: 6.4 or later is needed")
  endif()
  find_package(NLopt 2.7 REQUIRED CONFIG)
  include(SystemDependencies)
else()
  message(FATAL_ERROR "CRASHSIM_DEPS=${CRASHSIM_DEPS}: must be system or source")
endif()
