// Work on many particles side by side, where one particle's failure must not stop the others.
#pragma once

#include <cstddef>
#include <exception>
#include <string>

#include "common/error.hpp"

namespace xfem {

/// Calls body(k) for k = 0 ... count - 1 on `threads` threads. What body(k) throws as common::Error becomes the text of
/// failure(k); anything else is thrown on after the last call.
template <class Failure, class Body>
void for_each_guarded(std::size_t count, int threads, const Failure& failure, const Body& body) {
  std::exception_ptr fatal;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t k = 0; k < count; ++k) {
    try {
      body(k);
    } catch (const common::Error& error) {
      failure(k) = error.what();
    } catch (...) {
#pragma omp critical
      fatal = std::current_exception();
    }
  }
  if (fatal) std::rethrow_exception(fatal);
}

}  // namespace xfem
