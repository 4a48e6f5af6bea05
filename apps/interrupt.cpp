#include "interrupt.hpp"

#include <csignal>
#include <initializer_list>

#include <unistd.h>

namespace crashsim::cli {
namespace {

volatile std::sig_atomic_t cooperative = 0;
volatile std::sig_atomic_t pending = 0;

extern "C" void on_signal(int) {
  if (cooperative == 0 || pending != 0) ::_exit(kInterruptedExit);
  pending = 1;
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
}

CooperativeInterrupt::CooperativeInterrupt() { cooperative = 1; }
CooperativeInterrupt::~CooperativeInterrupt() { cooperative = 0; }

bool interrupted() { return pending != 0; }

}  // namespace crashsim::cli
