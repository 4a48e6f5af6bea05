# Compiles through ccache when it is there. Paths are taken relative to the source tree, so checkouts share the cache.
option(CRASHSIM_CCACHE "Compile through ccache when it is installed" ${PROJECT_IS_TOP_LEVEL})
find_program(CRASHSIM_CCACHE_PROGRAM ccache)
mark_as_advanced(CRASHSIM_CCACHE_PROGRAM)
if(CRASHSIM_CCACHE AND CRASHSIM_CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
                                  CCACHE_SLOPPINESS=pch_defines,time_macros ${CRASHSIM_CCACHE_PROGRAM})
endif()
