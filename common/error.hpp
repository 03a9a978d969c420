// The project's one error type. Libraries never print: they return values or throw this; `main` prints and exits.
#pragma once

#include <stdexcept>
#include <string>

namespace common {

/// Process exit codes; scripts rely on the numbers.
enum class ExitCode : int {
  success = 0,
  bad_input = 2,          ///< configuration, file or command line
  numerical_failure = 3,  ///< with the particle, frame and reason in the message
  io_failure = 4,         ///< disk full, unreadable or unwritable file
  interrupted = 130,
  terminated = 143,
};

/// An error whose message tells the user where it is, what was found and what was expected.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

inline Error bad_input(const std::string& message) {
  return {ExitCode::bad_input, message};
}
inline Error numerical_failure(const std::string& message) {
  return {ExitCode::numerical_failure, message};
}
inline Error io_failure(const std::string& message) {
  return {ExitCode::io_failure, message};
}

}  // namespace common
