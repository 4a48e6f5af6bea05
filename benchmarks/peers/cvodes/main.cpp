/// peer_cvodes FOLDER [--quick] [w1|w2|w3]...: a straightforward program on CVODES, on the workloads in FOLDER.

#include <algorithm>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "problem.hpp"

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool quick = std::erase(arguments, "--quick") > 0;
  if (arguments.empty()) {
    std::cerr << "usage: peer_cvodes FOLDER [--quick] [w1|w2|w3]...\n";
    return 2;
  }
  const std::string folder = arguments.front();
  const auto wanted = [&](const char* workload) {
    return arguments.size() == 1 || std::ranges::find(arguments, workload) != arguments.end();
  };
  try {
    if (wanted("w1")) peer::run_forward(folder, quick);
    if (wanted("w3")) peer::run_pitch(folder, quick);
    if (wanted("w2")) peer::run_fit(folder, quick);
  } catch (const std::exception& error) {
    std::cerr << "peer_cvodes: " << error.what() << '\n';
    return 1;
  }
}
