// What `xfem` makes of a scene or a laboratory test: the text of `xfem explain`.
#pragma once

#include <filesystem>
#include <string>

#include "common/config/lab_test.hpp"
#include "common/config/scene.hpp"

namespace xfem {

/// True if the file has a top-level key `test`, which makes it a laboratory test. Throws bad_input if it cannot be
/// read.
bool is_lab_test(const std::filesystem::path& file);

/// The resolved configuration, the effects that are on, the model's choices and the arrays that exist.
std::string explain(const common::Scene& scene);
std::string explain(const common::LabTest& test);

}  // namespace xfem
