#include "command.hpp"
#include "interrupt.hpp"

int main(int argc, char** argv) {
  crashsim::cli::install_interrupt_handler();
  return crashsim::cli::run_program({argv + 1, argv + argc});
}
