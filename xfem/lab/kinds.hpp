// One function per kind of laboratory test; each file says what the test is and where its theory is from.
#pragma once

#include "xfem/lab/laboratory.hpp"

namespace xfem {

/// Indirect tension of a disc, see brazilian.cpp.
LabSetup brazilian_test(const common::LabTest& test);
/// Blocks under uniform stress, see blocks.cpp.
LabSetup uniaxial_test(const common::LabTest& test);
LabSetup confined_test(const common::LabTest& test);
LabSetup tension_test(const common::LabTest& test);
/// Hoek-Brown (Eq. 4) at s1 = 0: x = |s3| / sigma_ci solves x^2 + m x = 1, so 2 / (m + sqrt(m^2 + 4)) of sigma_ci [Pa]:
/// 0.998 of sigma_ci / m for m = 25, 0.988 for m = 9.
double uniaxial_tensile_strength(const common::MaterialOptions& material);
/// A beam on two supports, see bending.cpp.
LabSetup bending_test(const common::LabTest& test);
/// Angular particles, see particles.cpp.
LabSetup point_load_test(const common::LabTest& test);
LabSetup multi_contact_test(const common::LabTest& test);

/// Throws bad_input where a loading key that `kind` does not use is not at its default: `used` names those it does.
void require_loading(const common::LabTest& test, const std::vector<std::string>& used);

}  // namespace xfem
