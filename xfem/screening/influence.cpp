#include "xfem/screening/influence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace xfem {
namespace {

constexpr int kLanes = 16;          // elements side by side
constexpr double kUnit = 0x1p-24;   // of rounding to float
constexpr int kBlock = 3 * kLanes;  // values of one block of a column
using Lanes = Eigen::Array<float, kLanes, 1>;

/// One column of the influence and what multiplies it.
struct Term {
  const float* column;
  float weight;
};

/// The largest g * sigma_ci over the elements of a column's blocks.
float largest_gauge(std::span<const Term> terms, int blocks, float m) {
  Lanes worst = Lanes::Zero();
  for (int block = 0; block < blocks; ++block) {
    Lanes xx = Lanes::Zero(), yy = Lanes::Zero(), xy = Lanes::Zero();
    for (const Term& term : terms) {
      const float* response = term.column + block * kBlock;
      xx += term.weight * Eigen::Map<const Lanes>(response);
      yy += term.weight * Eigen::Map<const Lanes>(response + kLanes);
      xy += term.weight * Eigen::Map<const Lanes>(response + 2 * kLanes);
    }
    const Lanes half = 0.5f * (xx - yy);
    const Lanes radius = (half * half + xy * xy).sqrt();
    const Lanes a = m * (0.5f * (xx + yy) - radius);
    const Lanes e = 4.0f * radius;
    worst = worst.max(0.5f * ((a * a + e * e).sqrt() - a));
  }
  return worst.maxCoeff();
}

}  // namespace

Influence::Influence(const IntactModel& model, const StressAverage& average, PolygonView outline)
    : loop_(model.boundary_loop()),
      moments_(second_moments(outline)),
      nodes_(static_cast<int>(model.boundary().size())),
      blocks_((static_cast<int>(model.mesh().triangles.size()) + kLanes - 1) / kLanes) {
  constexpr int kWidth = IntactModel::kSideBySide;
  using Cases = Eigen::Array<double, kWidth, 1>;
  const std::size_t elements = model.mesh().triangles.size();
  const std::size_t stride = static_cast<std::size_t>(blocks_) * kBlock;
  response_.assign(2 * nodes_ * stride, 0.0f);
  largest_.assign(2 * nodes_, 0.0);
  std::vector<double> stress, work, averaged(elements * (3 * kWidth));
  for (int first = 0; first < 2 * nodes_; first += kWidth) {
    model.unit_stresses(first, stress, work);
    average.average<3 * kWidth>(stress.data(), averaged.data());
    const int cases = std::min(kWidth, 2 * nodes_ - first);
    Cases largest = Cases::Zero();
    for (std::size_t e = 0; e < elements; ++e) {
      float* block = response_.data() + first * stride + (e / kLanes) * kBlock + e % kLanes;
      for (int c = 0; c < 3; ++c) {
        const Cases value = Eigen::Map<const Cases>(averaged.data() + (3 * e + c) * kWidth);
        largest = largest.max(value.abs());
        const Eigen::Array<float, kWidth, 1> rounded = value.cast<float>();
        for (int k = 0; k < cases; ++k) block[k * stride + c * kLanes] = rounded[k];
      }
    }
    std::copy_n(largest.data(), cases, largest_.begin() + first);
  }
}

Influence::Bound Influence::bound(std::span<const Load> loads, const HoekBrown& rock) const {
  Virial virial(moments_);
  std::vector<Term> terms;
  std::vector<double> weights;
  terms.reserve(4 * loads.size());
  weights.reserve(4 * loads.size());
  double sum = 0, scale = 0;
  const std::size_t stride = static_cast<std::size_t>(blocks_) * kBlock;
  for (const Load& load : loads) {
    const BoundaryLoop::Foot foot = loop_.nearest(load.point);
    virial.add(foot.point, load.force);
    const int next = foot.edge + 1 < nodes_ ? foot.edge + 1 : 0;
    for (const auto& [node, share] : {std::pair(foot.edge, 1 - foot.position), std::pair(next, foot.position)}) {
      for (int c = 0; c < 2; ++c) {
        const double weight = share * load.force[c];
        if (weight == 0) continue;
        const std::size_t j = 2 * static_cast<std::size_t>(node) + c;
        weights.push_back(weight);
        terms.push_back({response_.data() + j * stride, 0});
        scale = std::max(scale, std::abs(weight));
        sum += std::abs(weight) * largest_[j];
      }
    }
  }
  const Stress mean = virial.stress();
  if (!std::isfinite(sum) || !std::isfinite(scale)) return {0, mean};
  if (terms.empty()) return {std::numeric_limits<double>::infinity(), mean};
  for (std::size_t j = 0; j < terms.size(); ++j) terms[j].weight = static_cast<float>(weights[j] / scale);

  const double gauge = largest_gauge(terms, blocks_, static_cast<float>(rock.m_i));
  const double count = static_cast<double>(terms.size());
  const double margin = 3 * (count + 10) * (rock.m_i + 2) * kUnit * sum;
  const double inverse = (scale * gauge + margin) / rock.sigma_ci;
  return {std::isfinite(inverse) ? 1 / inverse : 0, mean};
}

}  // namespace xfem
