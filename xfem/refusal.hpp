// One particle of a frame on its own: what a refused analysis leaves, so that the refusal can be seen again alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/io/frame.hpp"
#include "common/io/split.hpp"

namespace xfem {

/// The contact state of particle `id` alone: itself, its contacts, and its partners, which count as boundary particles
/// and are not analysed. Its analysis is that in the whole frame, bit for bit.
common::Frame frame_of_particle(const common::Frame& frame, std::int64_t id);

/// The cracks of particle `id` alone.
common::Split split_of_particle(const common::Split& split, std::int64_t id);

/// Folder for what was refused when `split_file` was made: DIR/failure for DIR/splits/K.h5, else failure beside it.
std::filesystem::path refusal_folder(const std::filesystem::path& split_file);

/// Writes frame_K_particle_P.h5 into `folder` for each refused particle (the first ten, and none into a
/// folder that holds 200 files), and with `previous`
/// frame_K_particle_P_previous.h5 if that particle has cracks in it. Returns a sentence for people about each refusal,
/// with the command that solves it alone; a file that cannot be written is part of the sentence.
std::vector<std::string> keep_refusals(const common::Frame& frame, const common::Split* previous,
                                       const common::Split& split, const std::filesystem::path& folder);

}  // namespace xfem
