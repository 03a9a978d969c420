#include "tests/robustness/geometry/run_family.hpp"

#include <algorithm>

namespace differential {
namespace {

constexpr std::int64_t kBlock = 256;

}  // namespace

Tally run_family(const Family& family, std::int64_t count, std::int64_t first, std::int64_t exact_stride,
                 Kernel kernel) {
  Tally total;
#pragma omp parallel
  {
    Tally mine;
    std::vector<Sample> samples(kBlock);
#pragma omp for schedule(dynamic, 16)
    for (std::int64_t block = 0; block < (count + kBlock - 1) / kBlock; ++block) {
      const std::int64_t begin = block * kBlock;
      const std::int64_t size = std::min(kBlock, count - begin);
      for (std::int64_t k = 0; k < size; ++k) {
        Sample& sample = samples[k];
        const std::int64_t seed = first + begin + k;
        make_pair(family, static_cast<std::uint64_t>(seed), sample.pair);
        sample.feature = {};
        sample.key = {seed, 0, 0, 0};
        sample.exact = exact_stride > 0 && (begin + k) % exact_stride == 0;
      }
      // The feature that the pair itself leaves is what the second query starts from.
      for (std::int64_t k = 0; k < size; ++k) {
        kernel(samples[k].pair.a.view(), samples[k].pair.b.view(), samples[k].feature, nullptr);
      }
      check(std::span(samples).first(size), kernel, mine);
    }
#pragma omp critical
    total.add(mine);
  }
  return total;
}

}  // namespace differential
