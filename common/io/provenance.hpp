// Which program on which machine made a file. Stands in the group `provenance`, outside the payload and its hash.
#pragma once

#include <map>
#include <string>

namespace common {

/// git (commit, "-dirty" with uncommitted changes, "unknown" outside a repository), compiler, flags, host_cpu.
const std::map<std::string, std::string>& provenance();

}  // namespace common
