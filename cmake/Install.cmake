# Installation and the CMake package: find_package(crashsim CONFIG REQUIRED), crashsim::crashsim.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(CRASHSIM_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/crashsim)
file(RELATIVE_PATH CRASHSIM_RUNPATH /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
set(CMAKE_INSTALL_RPATH "$ORIGIN/${CRASHSIM_RUNPATH}")

# crashsim_install_library(<target>): the library, its headers and the package that finds them.
function(crashsim_install_library target)
  if(NOT CRASHSIM_INSTALL)
    return()
  endif()
  install(TARGETS ${target} EXPORT crashsimTargets)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/crashsim ${PROJECT_BINARY_DIR}/src/include/crashsim
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
  install(EXPORT crashsimTargets NAMESPACE crashsim:: DESTINATION ${CRASHSIM_CMAKEDIR})
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/crashsimConfig.cmake.in crashsimConfig.cmake
                                INSTALL_DESTINATION ${CRASHSIM_CMAKEDIR} PATH_VARS CMAKE_INSTALL_LIBDIR)
  write_basic_package_version_file(crashsimConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/crashsimConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/crashsimConfigVersion.cmake
          DESTINATION ${CRASHSIM_CMAKEDIR})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
  if(CRASHSIM_DEPS STREQUAL "source")
    install(DIRECTORY ${CRASHSIM_DEPS_PREFIX}/licenses DESTINATION ${CMAKE_INSTALL_DOCDIR})
  endif()
  if(NOT BUILD_SHARED_LIBS)
    crashsim_install_private_dependencies()
  endif()
endfunction()

# What a program that links the static library needs besides: the archives themselves, or where to find the packages.
function(crashsim_install_private_dependencies)
  if(CRASHSIM_DEPS STREQUAL "source")
    install(DIRECTORY ${CRASHSIM_DEPS_LIBDIR}/ DESTINATION ${CMAKE_INSTALL_LIBDIR}/crashsim
            FILES_MATCHING PATTERN "lib*.a")
    install(FILES ${PROJECT_SOURCE_DIR}/cmake/SourceDependencies.cmake DESTINATION ${CRASHSIM_CMAKEDIR})
  else()
    install(FILES ${PROJECT_SOURCE_DIR}/cmake/SystemDependencies.cmake DESTINATION ${CRASHSIM_CMAKEDIR})
  endif()
endfunction()
