#include "common/io/columns.hpp"
#include "common/io/hdf5_file.hpp"
#include "xfem/lab/report.hpp"

namespace xfem {

namespace {

std::vector<std::array<double, 3>> rows(const std::vector<Stress>& stresses) {
  std::vector<std::array<double, 3>> values;
  for (const Stress& s : stresses) values.push_back({s.xx, s.yy, s.xy});
  return values;
}

}  // namespace

void write_lab_result(const std::filesystem::path& file, const LabSetup& setup, const LabResult& result) {
  common::Contents contents;
  contents["@schema"] = common::text_item("lab/1");
  contents["@test"] = common::text_item(setup.test);
  contents["@first_failure_load"] = common::scalar_item(result.first_failure_load);
  contents["@breakage_load"] = common::scalar_item(result.breakage_load);
  const auto put = [&](const char* path, const auto& values, const char* unit, const char* description) {
    common::put_column(contents, path, values, unit, description);
  };
  put("mesh/nodes", result.mesh.nodes, "m", "node positions (x, y); y is the load axis, the centroid the origin");
  std::vector<std::array<std::int32_t, 3>> triangles(result.mesh.triangles.begin(), result.mesh.triangles.end());
  put("mesh/triangles", triangles, "1", "rows of mesh/nodes, counter-clockwise");
  put("stress/element", rows(result.element_stress), "Pa",
      "element stress (xx, yy, xy) at first failure, of the specimen without its cracks, compression positive");
  put("stress/averaged", rows(result.averaged_stress), "Pa",
      "average of stress/element that the criterion sees (xx, yy, xy), compression positive");

  std::vector<Vec2> load_points, forces;
  for (const Load& load : result.loads) {
    load_points.push_back(load.point);
    forces.push_back(load.force);
  }
  put("loads/point", load_points, "m", "where forces act (x, y)");
  put("loads/force", forces, "N", "forces on the specimen (x, y) at first failure, per metre of thickness");

  std::vector<std::int64_t> point_offset{0};
  std::vector<Vec2> points;
  for (const Crack& crack : result.breakage.cracks) {
    for (const CrackPoint& point : crack.points) points.push_back(point.position);
    point_offset.push_back(static_cast<std::int64_t>(points.size()));
  }
  put("cracks/point_offset", point_offset, "1", "first row in cracks/points; one entry more than cracks");
  put("cracks/points", points, "m", "crack polylines (x, y) at the end of the test");

  std::vector<std::int64_t> vertex_offset{0};
  std::vector<Vec2> vertices;
  for (const Polygon* fragment : {&result.breakage.left, &result.breakage.right}) {
    if (!result.breakage.path) break;
    vertices.insert(vertices.end(), fragment->begin(), fragment->end());
    vertex_offset.push_back(static_cast<std::int64_t>(vertices.size()));
  }
  put("fragments/vertex_offset", vertex_offset, "1", "first row in fragments/vertices; one entry more than fragments");
  put("fragments/vertices", vertices, "m", "outlines (x, y), counter-clockwise; none if the specimen did not break");
  common::write_hdf5(file, std::move(contents), {});
}

}  // namespace xfem
