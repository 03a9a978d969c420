#include "xfem/interrupts.hpp"

#include <unistd.h>

#include <csignal>

namespace xfem {

namespace {

volatile std::sig_atomic_t writing = 0;
volatile std::sig_atomic_t pending = 0;

void on_signal(int signal) {
  if (writing)
    pending = signal;
  else
    _exit(128 + signal);
}

}  // namespace

void exit_on_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A file beyond the limit on sizes is to be an error that names it.
  std::signal(SIGXFSZ, SIG_IGN);
}

NoInterruption::NoInterruption() {
  writing = 1;
}

NoInterruption::~NoInterruption() {
  writing = 0;
  if (pending) _exit(128 + pending);
}

}  // namespace xfem
