#include "xfem/crack/face_contact.hpp"

#include <algorithm>
#include <utility>

namespace xfem {
namespace {

/// Far more than the line search needs: what would still change then are openings of rounding size.
constexpr int kContactIterations = 50;

/// Adds the closed faces' penalty k l v v^T.
void add_penalty(DenseSymmetric& matrix, const FaceSegment& face, double stiffness) {
  for (const auto& [f, wf] : face.jumps) {
    for (const auto& [g, wg] : face.jumps) {
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
          const int row = 2 * f + a;
          const int column = 2 * g + b;
          if (row > column) continue;
          matrix.at(row, column) += stiffness * face.length * wf * face.normal[a] * wg * face.normal[b];
        }
      }
    }
  }
}

/// A q for a matrix of which only the upper triangle is stored.
Eigen::VectorXd product(const DenseSymmetric& matrix, const Eigen::VectorXd& q) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(matrix.size);
  for (int i = 0; i < matrix.size; ++i) {
    result[i] += matrix.at(i, i) * q[i];
    for (int j = i + 1; j < matrix.size; ++j) {
      result[i] += matrix.at(i, j) * q[j];
      result[j] += matrix.at(i, j) * q[i];
    }
  }
  return result;
}

double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Where on the way from q to q + step the energy 1/2 q S q - right q + 1/2 k sum l min(0, opening)^2 is least, as a
/// fraction in [0, 1]. Its derivative is piecewise linear and grows; it changes slope where a segment closes or opens.
double least_energy(const DenseSymmetric& schur, const Eigen::VectorXd& right, const std::vector<FaceSegment>& faces,
                    double penalty, const Eigen::VectorXd& q, const Eigen::VectorXd& step) {
  const double constant = dot(step, product(schur, q)) - dot(step, right);
  const double linear = dot(step, product(schur, step));
  std::vector<double> from, rate, bends{1.0};
  for (const FaceSegment& face : faces) {
    from.push_back(opening(face, q));
    rate.push_back(opening(face, step));
    const double bend = rate.back() != 0 ? -from.back() / rate.back() : 0;
    if (bend > 0 && bend < 1) bends.push_back(bend);
  }
  std::sort(bends.begin(), bends.end());
  const auto derivative = [&](double t) {
    double sum = constant + linear * t;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      sum += penalty * faces[i].length * std::min(0.0, from[i] + rate[i] * t) * rate[i];
    }
    return sum;
  };
  double low = 0;
  double at_low = derivative(low);
  for (const double bend : bends) {
    const double at_bend = derivative(bend);
    if (at_bend >= 0) return at_low < 0 ? low + (bend - low) * (at_low / (at_low - at_bend)) : low;
    low = bend;
    at_low = at_bend;
  }
  return 1;
}

}  // namespace

std::optional<FaceContact> solve_face_contact(const DenseSymmetric& schur, const Eigen::VectorXd& right,
                                              const std::vector<FaceSegment>& faces, double penalty) {
  const auto overlapping = [&](const Eigen::VectorXd& q) {
    std::vector<bool> closed;
    for (const FaceSegment& face : faces) closed.push_back(opening(face, q) < 0);
    return closed;
  };
  FaceContact contact;
  Eigen::VectorXd reached = Eigen::VectorXd::Zero(schur.size);
  std::vector<bool> closed(faces.size(), false);
  for (int iteration = 0; iteration < kContactIterations; ++iteration) {
    DenseSymmetric system = schur;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (closed[i]) add_penalty(system, faces[i], penalty);
    }
    std::optional<Eigen::VectorXd> q = solve_spd(std::move(system), right);
    if (!q) return std::nullopt;
    contact.q = std::move(*q);
    contact.closed_segments = static_cast<int>(std::count(closed.begin(), closed.end(), true));
    if (overlapping(contact.q) == closed) break;
    const Eigen::VectorXd step = contact.q - reached;
    reached += least_energy(schur, right, faces, penalty, reached, step) * step;
    closed = overlapping(reached);
  }
  return contact;
}

}  // namespace xfem
