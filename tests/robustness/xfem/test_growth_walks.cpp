#include <catch2/catch.hpp>

#include "tests/robustness/xfem/growth_walk.hpp"

TEST_CASE("Random growth steps leave nothing unbalanced, nothing singular, and no trace of the steps before") {
  for (const growth_walks::Family& family : growth_walks::families()) {
    growth_walks::Tally total;
    for (int number = 0; number < 40; ++number) {
      total.add(growth_walks::walk(family, number % 10 == 0 ? 300 : 75, 1000000 + number, 60, 3));
    }
    INFO(family.name << ": " << total.steps << " steps, " << (total.failures.empty() ? "" : total.failures.front()));
    CHECK(total.steps > 500);
    CHECK(total.wrong() == 0);
  }
}

TEST_CASE("Random growth with friction settles at every step, wherever production places cracks") {
  for (const char* name : {"free", "driven", "ragged", "neighbours"}) {
    for (const double friction : {0.6, 1.5}) {
      growth_walks::Tally total;
      for (int number = 0; number < 15; ++number) {
        total.add(growth_walks::walk(*growth_walks::family_named(name), 75, number, 60, 5, friction));
      }
      INFO(name << ", friction " << friction << ": " << total.steps << " steps, "
                << (total.failures.empty() ? "" : total.failures.front()));
      CHECK(total.steps > 400);
      CHECK(total.closed > 200);
      CHECK(total.wrong() == 0);
    }
  }
}
