// What a laboratory test leaves behind: summary.json, result.h5 and a figure.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "xfem/lab/laboratory.hpp"

namespace xfem {

/// Angle between the breakage line and the load axis (y) [degrees], 0 to 90; empty if the specimen did not break.
std::optional<double> fracture_angle_degrees(const BreakageResult& result);

/// The keys of a laboratory test's summary.json; loads in N per metre of thickness. What does not exist is null.
std::string lab_summary(const LabSetup& setup, const LabResult& result, const common::LabTest& test);

/// mesh/{nodes,triangles}, stress/{element,averaged} and loads/{point,force} at first failure,
/// cracks/{point_offset,points}, fragments/*.
void write_lab_result(const std::filesystem::path& file, const LabSetup& setup, const LabResult& result);

/// An SVG: the specimen coloured by 1 / lambda of the averaged stress at first failure, with loads and cracks, and
/// beside it the fragments apart.
std::string lab_figure(const LabSetup& setup, const LabResult& result, const common::LabTest& test);

/// The load factor's inverse of the averaged stress, per element: 1 where it fails first.
std::vector<double> utilization(const LabResult& result);

/// Writes a text atomically.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace xfem
