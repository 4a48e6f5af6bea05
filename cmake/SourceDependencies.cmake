# crashsim::sundials, crashsim::nlopt and crashsim::fmt from the archives in CRASHSIM_DEPS_LIBDIR. Also part of the installed package.
if(NOT TARGET crashsim::sundials)
  add_library(crashsim::sundials STATIC IMPORTED)
  set_target_properties(crashsim::sundials PROPERTIES IMPORTED_LOCATION ${CRASHSIM_DEPS_LIBDIR}/libsundials_cvodes.a)
  if(EXISTS ${CRASHSIM_DEPS_LIBDIR}/libsundials_core.a)  # since SUNDIALS 7
    target_link_libraries(crashsim::sundials INTERFACE ${CRASHSIM_DEPS_LIBDIR}/libsundials_core.a)
  endif()
  target_link_libraries(crashsim::sundials INTERFACE m)
  add_library(crashsim::nlopt STATIC IMPORTED)
  set_target_properties(crashsim::nlopt PROPERTIES IMPORTED_LOCATION ${CRASHSIM_DEPS_LIBDIR}/libnlopt.a)
  target_link_libraries(crashsim::nlopt INTERFACE m)
  add_library(crashsim::fmt STATIC IMPORTED)
  # FMT_SHARED says nothing here but "visible"; as the package has it, so that both ways share compiled objects.
  set_target_properties(crashsim::fmt PROPERTIES IMPORTED_LOCATION ${CRASHSIM_DEPS_LIBDIR}/libfmt.a
                                                 INTERFACE_COMPILE_DEFINITIONS FMT_SHARED)
endif()
