#include <catch2/catch.hpp>
#include <numeric>
#include <stdexcept>

#include "xfem/parallel.hpp"

TEST_CASE("Every particle is visited once, on any number of threads") {
  for (const int threads : {0, 1, 2, 3, 8}) {
    for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
      std::vector<int> visits(count, 0);
      std::vector<std::string> failures(count);
      xfem::for_each_guarded(
          count, threads, [&](std::size_t k) -> std::string& { return failures[k]; },
          [&](std::size_t k) { ++visits[k]; });
      CHECK(std::count(visits.begin(), visits.end(), 1) == static_cast<std::ptrdiff_t>(count));
    }
  }
}

TEST_CASE("One particle's failure is its own, any other exception ends the loop after the last particle") {
  for (const int threads : {1, 4}) {
    std::vector<int> visits(100, 0);
    std::vector<std::string> failures(100);
    const auto failure = [&](std::size_t k) -> std::string& { return failures[k]; };
    xfem::for_each_guarded(100, threads, failure, [&](std::size_t k) {
      ++visits[k];
      if (k % 10 == 3) throw common::numerical_failure("particle " + std::to_string(k));
    });
    for (std::size_t k = 0; k < 100; ++k) CHECK(failures[k] == (k % 10 == 3 ? "particle " + std::to_string(k) : ""));
    const auto breaks = [&](std::size_t k) {
      ++visits[k];
      if (k == 7) throw std::logic_error("not a particle's failure");
    };
    CHECK_THROWS_AS(xfem::for_each_guarded(100, threads, failure, breaks), std::logic_error);
    CHECK(std::accumulate(visits.begin(), visits.end(), 0) == 200);
  }
}
