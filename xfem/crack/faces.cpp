#include "xfem/crack/faces.hpp"

namespace xfem {

std::vector<FaceSegment> face_segments(const Mesh& mesh, std::span<const ElementGradients> gradients,
                                       const Enrichment& enrichment) {
  std::vector<FaceSegment> faces(enrichment.segments.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const CrackSegment& segment = enrichment.segments[i];
    const Vec2 along = segment.last.position - segment.first.position;
    faces[i].segment = static_cast<int>(i);
    faces[i].length = along.norm();
    faces[i].normal = common::perpendicular(along) / faces[i].length;
  }
  for (const CutElement& element : enrichment.cut) {
    const Vec2 center = mesh.centroid(element.element);
    for (const CutElement::Term& term : element.terms) {
      const int index = element.segments[term.slot];
      const CrackSegment& segment = enrichment.segments[index];
      const Vec2 middle = (segment.first.position + segment.last.position) / 2;
      const double shape = 1.0 / 3 + gradients[element.element].gradient[term.local].dot(middle - center);
      faces[index].jumps.emplace_back(term.function, 2 * shape);
    }
  }
  std::erase_if(faces, [](const FaceSegment& face) { return face.jumps.empty() || !(face.length > 0); });
  return faces;
}

double opening(const FaceSegment& segment, const Eigen::VectorXd& q) {
  double sum = 0;
  for (const auto& [function, weight] : segment.jumps) {
    sum += weight * (segment.normal.x() * q[2 * function] + segment.normal.y() * q[2 * function + 1]);
  }
  return sum;
}

double slip(const FaceSegment& segment, const Eigen::VectorXd& q) {
  double sum = 0;
  for (const auto& [function, weight] : segment.jumps) {
    sum += weight * (segment.normal.y() * q[2 * function] - segment.normal.x() * q[2 * function + 1]);
  }
  return sum;
}

}  // namespace xfem
