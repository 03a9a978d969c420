// Many pairs of one family.
#pragma once

#include "tests/robustness/geometry/check.hpp"
#include "tests/robustness/geometry/families.hpp"

namespace differential {

/// Checks the pairs with the seeds first ... first + count - 1, each `exact_stride`-th in exact arithmetic (0: none but
/// the undecided ones), on as many threads as OpenMP has. Times apart, the counts do not depend on their number.
Tally run_family(const Family& family, std::int64_t count, std::int64_t first, std::int64_t exact_stride,
                 Kernel kernel);

}  // namespace differential
