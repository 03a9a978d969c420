#include "xfem/profile.hpp"

#include <nlohmann/json.hpp>
#include <span>

#include "common/io/immutable_file.hpp"

namespace xfem {

std::string profile_event(const PhaseSeconds& seconds, const PhaseCounts& counts) {
  return nlohmann::ordered_json{{"event", "profile"}, {"seconds", seconds}, {"counts", counts}}.dump();
}

void write_profile(const std::filesystem::path& file, const PhaseSeconds& seconds, const PhaseCounts& counts) {
  nlohmann::ordered_json profile;
  profile["seconds"] = seconds;
  profile["counts"] = counts;
  const std::string text = profile.dump(2) + "\n";
  common::write_atomically(file, std::as_bytes(std::span(text)), {});
}

}  // namespace xfem
