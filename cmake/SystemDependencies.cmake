# crashsim::sundials, crashsim::nlopt and crashsim::fmt from the packages found before. Also part of the installed package.
if(NOT TARGET crashsim::sundials)
  add_library(crashsim::sundials INTERFACE IMPORTED)
  target_link_libraries(crashsim::sundials INTERFACE SUNDIALS::cvodes)
  add_library(crashsim::nlopt INTERFACE IMPORTED)
  target_link_libraries(crashsim::nlopt INTERFACE NLopt::nlopt)
  add_library(crashsim::fmt INTERFACE IMPORTED)
  target_link_libraries(crashsim::fmt INTERFACE fmt::fmt)
endif()
