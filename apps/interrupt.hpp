#pragma once
/// Ctrl-C: at once where nothing is lost, after the work in hand where something would be.

namespace crashsim::cli {

inline constexpr int kInterruptedExit = 130;

/// From now on SIGINT and SIGTERM end the program with exit code 130.
void install_interrupt_handler();

/// While it lives the first signal only sets interrupted(); the second one ends the program.
class CooperativeInterrupt {
 public:
  CooperativeInterrupt();
  ~CooperativeInterrupt();
  CooperativeInterrupt(const CooperativeInterrupt&) = delete;
  CooperativeInterrupt& operator=(const CooperativeInterrupt&) = delete;
};

/// Whether a signal came.
bool interrupted();

}  // namespace crashsim::cli
