// A figure without a plotting library: SVG is text.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "common/io/immutable_file.hpp"
#include "xfem/lab/report.hpp"

namespace xfem {

namespace {

constexpr double kWidth = 620, kMargin = 40, kLegend = 110;

/// Light to dark blue for 0 to 1, by linear interpolation between five colours.
std::string colour(double value) {
  constexpr std::array<std::array<double, 3>, 5> kScale{
      {{247, 251, 255}, {198, 219, 239}, {107, 174, 214}, {33, 113, 181}, {8, 48, 107}}};
  const double position = std::clamp(value, 0.0, 1.0) * (kScale.size() - 1);
  const auto low = std::min<std::size_t>(static_cast<std::size_t>(position), kScale.size() - 2);
  const double part = position - static_cast<double>(low);
  std::array<int, 3> rgb;
  for (int c = 0; c < 3; ++c)
    rgb[c] = static_cast<int>(std::lround((1 - part) * kScale[low][c] + part * kScale[low + 1][c]));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

/// From the specimen's metres (y up) to the figure's pixels (y down).
struct Canvas {
  Vec2 low, high;
  double scale;
  std::string at(const Vec2& p) const {
    return fmt::format("{:.2f},{:.2f}", kMargin + scale * (p.x() - low.x()), kMargin + 40 + scale * (high.y() - p.y()));
  }
  std::string polygon(PolygonView vertices, const std::string& style) const {
    std::string points;
    for (const Vec2& v : vertices) points += at(v) + " ";
    return fmt::format("<polygon points=\"{}\" {}/>\n", points, style);
  }
  double bottom() const { return kMargin + 40 + scale * (high.y() - low.y()); }
  double right() const { return kMargin + scale * (high.x() - low.x()); }
};

std::string legend(const Canvas& canvas) {
  const double x = canvas.right() + 30, top = kMargin + 60, height = 200;
  constexpr int kSteps = 40;
  std::string text;
  for (int k = 0; k < kSteps; ++k)
    text += fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"16\" height=\"{:.2f}\" fill=\"{}\"/>\n", x,
                        top + height * k / kSteps, height / kSteps + 0.5, colour(1 - (k + 0.5) / kSteps));
  for (double tick : {0.0, 0.5, 1.0})
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{:.1f}</text>\n", x + 22, top + height * (1 - tick) + 4, tick);
  text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">1 / lambda</text>\n", x, top - 12);
  return text;
}

}  // namespace

void write_lab_figure(const std::filesystem::path& file, const LabSetup& setup, const LabResult& result) {
  Canvas canvas{setup.outline[0], setup.outline[0], 0};
  for (const Vec2& v : setup.outline) {
    canvas.low = canvas.low.cwiseMin(v);
    canvas.high = canvas.high.cwiseMax(v);
  }
  canvas.scale = (kWidth - 2 * kMargin - kLegend) /
                 std::max(canvas.high.x() - canvas.low.x(), 0.7 * (canvas.high.y() - canvas.low.y()));

  std::string body;
  const HoekBrown rock = result.rock;
  for (std::size_t e = 0; e < result.mesh.triangles.size(); ++e) {
    const auto& t = result.mesh.triangles[e];
    const std::array<Vec2, 3> corners{result.mesh.nodes[t[0]], result.mesh.nodes[t[1]], result.mesh.nodes[t[2]]};
    const PrincipalStress p = principal(result.averaged_stress[e]);
    body += canvas.polygon(corners, fmt::format("fill=\"{}\" stroke=\"#9aa5b1\" stroke-width=\"0.4\"",
                                                colour(1 / rock.load_factor(p.s1, p.s3))));
  }
  const BreakageResult& breakage = result.breakage;
  if (breakage.path)
    for (const Polygon* fragment : {&breakage.left, &breakage.right})
      body += canvas.polygon(*fragment, "fill=\"none\" stroke=\"black\" stroke-width=\"1.6\"");
  else
    body += canvas.polygon(setup.outline, "fill=\"none\" stroke=\"black\" stroke-width=\"1.6\"");
  for (const Crack& crack : breakage.cracks) {
    std::string points;
    for (const CrackPoint& p : crack.points) points += canvas.at(p.position) + " ";
    body += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"#d62728\" stroke-width=\"2.4\"/>\n", points);
  }

  const double width = canvas.right() + kLegend + kMargin, height = canvas.bottom() + kMargin;
  const std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"white\"/>\n"
      "<text x=\"{2}\" y=\"26\" font-size=\"15\">{3} test, {4} nodes</text>\n"
      "<text x=\"{2}\" y=\"44\">first failure {5:.4f}, breakage {6:.4f} of theory</text>\n"
      "<text x=\"{2}\" y=\"60\" fill=\"#555\">colour: 1 / lambda at first failure; cracks red, fragments black</text>"
      "\n{7}{8}</svg>\n",
      width, height, kMargin, setup.test, result.mesh.nodes.size(), result.first_failure_load / setup.theory_load,
      result.breakage_load / setup.theory_load, body, legend(canvas));
  common::write_atomically(file, std::as_bytes(std::span(text)), {});
}

}  // namespace xfem
