// Loops over fixed blocks of an array by a team of threads. A block is the same whatever the number of threads, so sums
// that are formed per block and added up in block order are the same as well, bit for bit.
//
// A step has a few such loops of some ten microseconds each. The threads stay for the whole run and wait for the next
// loop spinning, but only for a short while: on a busy machine a longer spin takes the time slice from the very thread
// that is waited for (OpenMP's default, 30 times slower there).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

namespace dem {

class Team {
 public:
  /// Entries of one block: some microseconds of work, and few enough blocks that their sums cost nothing.
  static constexpr std::size_t kBlock = 64;

  /// `threads` in all, the calling one included. Throws bad_input if the system does not give as many.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Calls visit(block, first, last) for every block of `entries`. `visit` must not throw.
  template <class Visit>
  void for_blocks(std::size_t entries, const Visit& visit) {
    const Loop loop{[](const void* context, std::size_t block, std::size_t first, std::size_t last) {
                      (*static_cast<const Visit*>(context))(block, first, last);
                    },
                    &visit, entries};
    run(loop);
  }

  /// Sum over all blocks, in their order, of what visit(first, last) returns. `sums` is scratch.
  template <class Sum, class Visit>
  Sum sum_blocks(std::size_t entries, std::vector<Sum>& sums, const Visit& visit) {
    sums.resize(block_count(entries));
    for_blocks(entries,
               [&](std::size_t block, std::size_t first, std::size_t last) { sums[block] = visit(first, last); });
    Sum total{};
    for (const Sum& sum : sums) total += sum;
    return total;
  }

 private:
  struct Loop {
    void (*call)(const void* context, std::size_t block, std::size_t first, std::size_t last);
    const void* context;
    std::size_t entries;
  };
  static std::size_t block_count(std::size_t entries) { return (entries + kBlock - 1) / kBlock; }

  void end();
  void run(const Loop& loop);
  void work(std::size_t member);
  void do_share(std::size_t member) const;

  std::vector<std::thread> workers_;
  Loop loop_{};
  alignas(64) std::atomic<std::uint32_t> started_{0};  ///< loops handed out; the last one ends the team
  alignas(64) std::atomic<std::uint32_t> busy_{0};     ///< workers that have not finished the loop
  bool ending_ = false;
};

}  // namespace dem
