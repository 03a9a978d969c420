#include "xfem/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>

#include "common/error.hpp"

namespace xfem {
namespace {

// A scene that fails everywhere fills no disk, in one frame or over a run that goes on past refusals.
constexpr std::size_t kMostOfFrame = 10;
constexpr std::ptrdiff_t kMostFiles = 200;

template <class T>
void push_if_there(std::vector<T>& to, const std::vector<T>& from, std::size_t i) {
  if (i < from.size()) to.push_back(from[i]);
}

std::ptrdiff_t files_in(const std::filesystem::path& folder) {
  std::error_code none;  // a folder that is not there holds no files
  return std::distance(std::filesystem::directory_iterator(folder, none), {});
}

}  // namespace

common::Frame frame_of_particle(const common::Frame& frame, std::int64_t id) {
  common::Frame own;
  own.frame = frame.frame;
  own.step = frame.step;
  own.time = frame.time;
  own.stage = frame.stage;
  own.axial_strain = frame.axial_strain;
  own.seed = frame.seed;
  own.next_id = frame.next_id;
  own.friction = frame.friction;
  own.config_hash = frame.config_hash;

  const common::Contacts& all = frame.contacts;
  std::vector<std::int64_t> ids{id};
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (all.a[c] != id && all.b[c] != id) continue;
    ids.push_back(all.a[c] == id ? all.b[c] : all.a[c]);
    own.contacts.a.push_back(all.a[c]);
    own.contacts.b.push_back(all.b[c]);
    own.contacts.point.push_back(all.point[c]);
    own.contacts.force.push_back(all.force[c]);
  }
  std::sort(ids.begin(), ids.end());
  const common::Particles& p = frame.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!std::binary_search(ids.begin(), ids.end(), p.id[i])) continue;
    own.particles.id.push_back(p.id[i]);
    own.particles.position.push_back(p.position[i]);
    own.particles.angle.push_back(p.angle[i]);
    own.particles.boundary.push_back(p.id[i] == id ? p.boundary[i] : std::uint8_t{1});
    const common::PolygonView outline = p.outline(i);
    own.particles.vertices.insert(own.particles.vertices.end(), outline.begin(), outline.end());
    own.particles.vertex_offset.push_back(static_cast<std::int64_t>(own.particles.vertices.size()));
  }
  return own;
}

common::Split split_of_particle(const common::Split& split, std::int64_t id) {
  common::Split own;
  own.frame = split.frame;
  own.frame_hash = split.frame_hash;
  own.config_hash = split.config_hash;
  const auto& cracks = split.cracks;
  for (std::size_t k = 0; k < cracks.particle.size(); ++k) {
    if (cracks.particle[k] != id) continue;
    own.cracks.particle.push_back(id);
    for (std::int64_t at = cracks.point_offset[k]; at < cracks.point_offset[k + 1]; ++at) {
      const auto point = static_cast<std::size_t>(at);
      own.cracks.points.push_back(cracks.points[point]);
      push_if_there(own.cracks.edge, cracks.edge, point);
      push_if_there(own.cracks.edge_fraction, cracks.edge_fraction, point);
    }
    own.cracks.point_offset.push_back(static_cast<std::int64_t>(own.cracks.points.size()));
    push_if_there(own.cracks.tip_state, cracks.tip_state, k);
  }
  // Whoever has cracks must be named, and a fragment was not yet a particle then; what was found of it does not count.
  own.particles.id = {id};
  own.particles.status = {common::ParticleStatus::arrested};
  own.particles.mean_stress = {{0, 0, 0}};
  own.particles.min_safety_factor = {0};
  own.particles.failure_mode = {common::FailureMode::none};
  return own;
}

std::filesystem::path refusal_folder(const std::filesystem::path& split_file) {
  const std::filesystem::path folder = split_file.parent_path();
  return (folder.filename() == "splits" ? folder.parent_path() : folder) / "failure";
}

std::vector<std::string> keep_refusals(const common::Frame& frame, const common::Split* previous,
                                       const common::Split& split, const std::filesystem::path& folder) {
  std::vector<std::string> sentences;
  for (std::size_t r = 0; r < split.refusals.particle.size(); ++r) {
    const std::int64_t id = split.refusals.particle[r];
    std::string text =
        fmt::format("frame {}: particle {}: analysis refused: {}", frame.frame, id, split.refusals.reason[r]);
    if (r < kMostOfFrame && files_in(folder) < kMostFiles) {
      const std::string name = (folder / fmt::format("frame_{:06}_particle_{}", frame.frame, id)).string();
      try {
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        if (error) throw common::io_failure(fmt::format("{}: cannot create: {}", folder.string(), error.message()));
        common::Frame own = frame_of_particle(frame, id);
        common::write_frame(name + ".h5", own, {});
        std::string command = fmt::format("xfem solve {}.h5 --config CASE.yaml", name);
        common::Split cracks = previous ? split_of_particle(*previous, id) : common::Split{};
        if (!cracks.cracks.particle.empty()) {
          common::write_split(name + "_previous.h5", cracks, {});
          command += fmt::format(" --previous {}_previous.h5", name);
        }
        text += fmt::format("; alone: {} --out SPLIT.h5", command);
      } catch (const common::Error& not_kept) {
        text += fmt::format("; it could not be kept: {}", not_kept.what());
      }
    }
    sentences.push_back(std::move(text));
  }
  return sentences;
}

}  // namespace xfem
