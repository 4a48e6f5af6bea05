# crashsim::sundials and crashsim::nlopt from the packages found before. Also part of the installed package.
if(NOT TARGET crashsim::sundials)
  add_library(crashsim::sundials INTERFACE IMPORTED)
  target_link_libraries(crashsim::sundials INTERFACE SUNDIALS::cvodes)
  add_library(crashsim::nlopt INTERFACE IMPORTED)
  target_link_libraries(crashsim::nlopt INTERFACE NLopt::nlopt)
endif()
