# Everything crashsim links, found in one place.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(SUNDIALS 6.4 REQUIRED CONFIG
             COMPONENTS cvodes nvecserial sunmatrixdense sunlinsoldense sunnonlinsolfixedpoint)
find_package(NLopt 2.7 REQUIRED)
find_package(tomlplusplus 3.3 REQUIRED CONFIG)
