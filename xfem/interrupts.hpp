// SIGINT and SIGTERM end the process with exit code 130 or 143, but never in the middle of writing a file.
// Beyond the limit on the size of files a write fails with EFBIG, as every failing write does, instead of ending the
// process.
#pragma once

namespace xfem {

/// Installs the handlers; called once, by `main`.
void exit_on_signals();

/// While one of these lives, a signal waits; it ends the process when the object goes. Not nested.
class NoInterruption {
 public:
  NoInterruption();
  ~NoInterruption();
  NoInterruption(const NoInterruption&) = delete;
  NoInterruption& operator=(const NoInterruption&) = delete;
};

}  // namespace xfem
