// Work on many particles side by side, where one particle's failure must not stop the others.
#pragma once

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "common/error.hpp"

namespace xfem {

/// Processors that this process may use: fewer than the machine has where a scheduler or taskset says so; at least 1.
inline int available_processors() {
  cpu_set_t mask;
  if (sched_getaffinity(0, sizeof mask, &mask) != 0)
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return CPU_COUNT(&mask);
}

/// Calls body(k) for k = 0 ... count - 1 on `threads` threads (fewer if the system does not give as many). What body(k)
/// throws as common::Error becomes the text of failure(k); anything else is thrown on after the last call.
/// Threads of the language, not OpenMP's: GCC's runtime synchronizes unseen by ThreadSanitizer.
template <class Failure, class Body>
void for_each_guarded(std::size_t count, int threads, const Failure& failure, const Body& body) {
  std::atomic<std::size_t> next{0};
  std::mutex fatal_mutex;
  std::exception_ptr fatal;
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) {
      try {
        body(k);
      } catch (const common::Error& error) {
        failure(k) = error.what();
      } catch (...) {
        const std::lock_guard lock(fatal_mutex);
        fatal = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (std::size_t member = 1; member < std::min(count, static_cast<std::size_t>(std::max(threads, 1))); ++member) {
        others.emplace_back(work);
      }
    } catch (const std::system_error&) {
      // Those that there are do it all.
    }
    work();
  }
  if (fatal) std::rethrow_exception(fatal);
}

}  // namespace xfem
