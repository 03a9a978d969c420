#include "dem/team.hpp"

#include <fmt/format.h>

#include <system_error>

#include "common/error.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace dem {
namespace {

constexpr int kSpins = 2000;  // a few tens of microseconds

void pause() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

// Waits until `value` differs from `old`.
std::uint32_t wait_for_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  for (int spin = 0; spin < kSpins; ++spin) {
    const std::uint32_t now = value.load(std::memory_order_acquire);
    if (now != old) return now;
    pause();
  }
  value.wait(old, std::memory_order_acquire);
  return value.load(std::memory_order_acquire);
}

}  // namespace

Team::Team(int threads) {
  try {
    for (int member = 1; member < threads; ++member) {
      workers_.emplace_back([this, member] { work(static_cast<std::size_t>(member)); });
    }
  } catch (const std::system_error& error) {
    const std::size_t started = workers_.size() + 1;
    end();
    throw common::bad_input(
        fmt::format("threads: found {}, but only {} could be started ({})", threads, started, error.what()));
  }
}

Team::~Team() {
  end();
}

void Team::end() {
  ending_ = true;
  started_.fetch_add(1, std::memory_order_release);
  started_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void Team::run(const Loop& loop) {
  loop_ = loop;
  if (workers_.empty()) return do_share(0);
  busy_.store(static_cast<std::uint32_t>(workers_.size()), std::memory_order_relaxed);
  started_.fetch_add(1, std::memory_order_release);
  started_.notify_all();
  do_share(0);
  for (std::uint32_t left = busy_.load(std::memory_order_acquire); left != 0;) left = wait_for_change(busy_, left);
}

void Team::work(std::size_t member) {
  for (std::uint32_t seen = 0;;) {
    seen = wait_for_change(started_, seen);
    if (ending_) return;
    do_share(member);
    if (busy_.fetch_sub(1, std::memory_order_release) == 1) busy_.notify_one();
  }
}

void Team::do_share(std::size_t member) const {
  const std::size_t blocks = block_count(loop_.entries);
  const std::size_t members = workers_.size() + 1;
  const std::size_t end = blocks * (member + 1) / members;
  for (std::size_t block = blocks * member / members; block < end; ++block) {
    loop_.call(loop_.context, block, block * kBlock, std::min(loop_.entries, (block + 1) * kBlock));
  }
}

}  // namespace dem
