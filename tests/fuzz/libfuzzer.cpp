// The fuzzer of one target, ROCKBREAK_FUZZ_TARGET.
#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ROCKBREAK_FUZZ_TARGET({data, size});
  return 0;
}
