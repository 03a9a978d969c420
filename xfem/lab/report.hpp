// What a laboratory test leaves behind: summary.json, result.h5 and a figure.
#pragma once

#include <filesystem>
#include <optional>

#include "xfem/lab/laboratory.hpp"

namespace xfem {

/// Angle between the breakage line and the load axis (y) [degrees], 0 to 90; empty if the specimen did not break.
std::optional<double> fracture_angle_degrees(const BreakageResult& result);

/// The keys of a laboratory test's summary.json; loads in N per metre of thickness. What does not exist is null.
void write_lab_summary(const std::filesystem::path& file, const LabSetup& setup, const LabResult& result,
                       const common::LabTest& test);

/// mesh/{nodes,triangles}, stress/{element,averaged} at first failure, cracks/{point_offset,points}, fragments/*.
void write_lab_result(const std::filesystem::path& file, const LabSetup& setup, const LabResult& result);

/// The mesh coloured by the load factor of the averaged stress at first failure, fragments outlined, cracks in red.
void write_lab_figure(const std::filesystem::path& file, const LabSetup& setup, const LabResult& result);

}  // namespace xfem
