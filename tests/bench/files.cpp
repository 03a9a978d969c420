// A frame to a file and back, all checks included.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "dem/checkpoint.hpp"
#include "pile.hpp"

namespace {

std::filesystem::path file() {
  return std::filesystem::temp_directory_path() / "rockbreak_bench_frame.h5";
}

common::Frame frame() {
  return dem::to_frame(bench::pile(), bench::pile_scene(), common::Stage::shear);
}

void write_frame(benchmark::State& state) {
  common::Frame f = frame();
  for (auto _ : state) common::write_frame(file(), f, {});
}
BENCHMARK(write_frame);

void read_frame(benchmark::State& state) {
  common::Frame f = frame();
  common::write_frame(file(), f, {});
  for (auto _ : state) benchmark::DoNotOptimize(common::read_frame(file()));
  std::filesystem::remove(file());
}
BENCHMARK(read_frame);

}  // namespace
