#include "common/io/frame.hpp"
#include "common/io/split.hpp"
#include "tests/fuzz/targets.hpp"

namespace fuzz {

void file_bytes(Input input) {
  const std::filesystem::path path = scratch_file("bytes.h5", input);
  for (const auto content :
       {common::FrameContent::everything, common::FrameContent::contact_state, common::FrameContent::particles}) {
    unless_refused([&] { common::read_frame(path, content); });
  }
  unless_refused([&] { common::read_split(path); });
}

}  // namespace fuzz
