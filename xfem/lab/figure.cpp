// A figure without a plotting library: SVG is text.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "xfem/lab/report.hpp"

namespace xfem {

namespace {

constexpr double kPanel = 430, kMargin = 44, kHead = 104, kLegend = 96, kCaption = 16;
constexpr int kColours = 64;
constexpr const char* kSoft = "fill=\"#52606d\"";
/// Above this the mesh lines would cover the field.
constexpr std::size_t kMostDrawnElements = 4000;

/// Viridis (van der Walt & Smith 2015), 0 dark to 1 light: safe for colour-blind readers and in grey.
std::string colour(double value) {
  constexpr std::array<std::array<double, 3>, 9> kScale{{{68, 1, 84},
                                                         {71, 44, 122},
                                                         {59, 81, 139},
                                                         {44, 113, 142},
                                                         {33, 144, 141},
                                                         {39, 173, 129},
                                                         {92, 200, 99},
                                                         {170, 220, 50},
                                                         {253, 231, 37}}};
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
  double scale = 1, left = 0;
  Vec2 pixel(const Vec2& p) const {
    return {left + scale * (p.x() - low.x()), kHead + kMargin + scale * (high.y() - p.y())};
  }
  std::string at(const Vec2& p) const {
    const Vec2 q = pixel(p);
    return fmt::format("{:.1f} {:.1f}", q.x(), q.y());
  }
  std::string closed(PolygonView vertices) const {
    std::string text;
    for (const Vec2& v : vertices) {
      text += text.empty() ? 'M' : 'L';
      text += at(v);
    }
    return text + 'Z';
  }
  double width() const { return scale * (high.x() - low.x()); }
  double bottom() const { return kHead + kMargin + scale * (high.y() - low.y()); }
};

std::string path(const std::string& data, const std::string& style) {
  return fmt::format("<path d=\"{}\" {}/>\n", data, style);
}

std::string label(double x, double y, const std::string& style, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, style, text);
}

/// All elements of one colour are one path, which keeps fine meshes small.
std::string field(const Canvas& canvas, const LabResult& result) {
  const std::vector<double> values = utilization(result);
  std::map<int, std::string> triangles;
  std::string edges;
  for (std::size_t e = 0; e < values.size(); ++e) {
    const auto& t = result.mesh.triangles[e];
    const std::array<Vec2, 3> corners{result.mesh.nodes[t[0]], result.mesh.nodes[t[1]], result.mesh.nodes[t[2]]};
    const std::string outline = canvas.closed(corners);
    triangles[std::clamp(static_cast<int>(values[e] * kColours), 0, kColours - 1)] += outline;
    if (values.size() <= kMostDrawnElements) edges += outline;
  }
  std::string text;
  for (const auto& [level, data] : triangles) {
    const std::string shade = colour((level + 0.5) / kColours);
    text += path(data, fmt::format("fill=\"{0}\" stroke=\"{0}\" stroke-width=\"0.5\"", shade));
  }
  if (!edges.empty())
    text += path(edges, "fill=\"none\" stroke=\"white\" stroke-opacity=\"0.28\" stroke-width=\"0.5\"");
  return text;
}

/// A push ends at its point, a pull starts there.
std::string arrows(const Canvas& canvas, const LabSetup& setup, const std::vector<Load>& loads) {
  double largest = 0;
  for (const Load& load : loads) largest = std::max(largest, load.force.norm());
  const double longest = loads.size() > 20 ? 16 : 30;
  std::string text;
  for (const Load& load : loads) {
    const double length = largest > 0 ? longest * load.force.norm() / largest : 0;
    if (length < 2) continue;
    const Vec2 along{load.force.x() / load.force.norm(), -load.force.y() / load.force.norm()};
    const bool pulls = load.force.dot(load.point) > 0;
    const Vec2 point = canvas.pixel(load.point);
    const Vec2 head = pulls ? Vec2(point + length * along) : point, tail = head - length * along;
    const Vec2 side{-along.y(), along.x()};
    const double barb = std::min(5.0, 0.5 * length);
    const Vec2 one = head - barb * along + 0.5 * barb * side, other = head - barb * along - 0.5 * barb * side;
    text += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}", tail.x(), tail.y(),
                        head.x(), head.y(), one.x(), one.y(), head.x(), head.y(), other.x(), other.y());
  }
  return path(text,
              fmt::format("fill=\"none\" stroke=\"#1f2933\" stroke-width=\"{}\"", setup.load_patch > 0 ? 2 : 1.4));
}

std::string cracks(const Canvas& canvas, const std::vector<Crack>& all) {
  std::string lines;
  for (const Crack& crack : all)
    for (std::size_t i = 0; i < crack.points.size(); ++i) {
      lines += i == 0 ? 'M' : 'L';
      lines += canvas.at(crack.points[i].position);
    }
  if (lines.empty()) return "";
  return path(lines, "fill=\"none\" stroke=\"white\" stroke-width=\"5\" stroke-linejoin=\"round\"") +
         path(lines, "fill=\"none\" stroke=\"#d55e00\" stroke-width=\"2.6\" stroke-linejoin=\"round\"");
}

std::string fragments(const Canvas& canvas, const LabSetup& setup, const BreakageResult& breakage) {
  if (!breakage.path)
    return path(canvas.closed(setup.outline), "fill=\"#eef1f4\" stroke=\"#1f2933\" stroke-width=\"1.5\"") +
           cracks(canvas, breakage.cracks);
  std::string text;
  const Vec2 line = (*breakage.path)[1] - (*breakage.path)[0];
  const Vec2 apart = common::perpendicular(line) / line.norm() * (9 / canvas.scale);
  const double whole = common::area(setup.outline);
  for (const bool is_left : {true, false}) {
    Polygon moved = is_left ? breakage.left : breakage.right;
    for (Vec2& v : moved) v += is_left ? apart : Vec2(-apart);
    text += path(canvas.closed(moved),
                 fmt::format("fill=\"{}\" stroke=\"#1f2933\" stroke-width=\"1.5\"", is_left ? "#cfe4f2" : "#fbe3c4"));
    const Vec2 middle = canvas.pixel(common::centroid(moved));
    text += label(middle.x(), middle.y() + 4, "text-anchor=\"middle\"",
                  fmt::format("{:.1f} %", 100 * common::area(moved) / whole));
  }
  return text;
}

std::string legend(double x, double top) {
  const double height = 220;
  std::string text = label(x, top - 14, "", "1 / λ");
  for (int k = 0; k < kColours; ++k)
    text += fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"16\" height=\"{:.2f}\" fill=\"{}\"/>\n", x,
                        top + height * k / kColours, height / kColours + 0.4, colour(1 - (k + 0.5) / kColours));
  for (const double tick : {0.0, 0.25, 0.5, 0.75, 1.0})
    text += label(x + 22, top + height * (1 - tick) + 4, "", fmt::format("{:.2f}", tick));
  return text;
}

std::string headline(const LabSetup& setup, const LabResult& result, const common::LabTest& test, double height) {
  std::string name = setup.test;
  std::replace(name.begin(), name.end(), '_', ' ');
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  const std::string title = name + " test" + (test.material.name.empty() ? "" : ": " + test.material.name);
  const std::string model =
      fmt::format("σci = {:.4g} MPa, m = {:.3g} · {} nodes, h = {:.3g} of the height", test.material.sigma_ci / 1e6,
                  test.material.m_i, result.mesh.nodes.size(), result.mesh.size / height);
  const auto load = [&](double value) {
    if (!std::isfinite(value)) return std::string("none");
    std::string text = fmt::format("{:.4g} kN/m", value / 1e3);
    if (setup.theory_load) text += fmt::format(" = {:.3f} of theory", value / *setup.theory_load);
    return text;
  };
  const std::optional<double> angle = fracture_angle_degrees(result.breakage);
  const char* mode = result.first_failure_mode == FailureMode::tension ? "tension"
                     : result.first_failure_mode == FailureMode::shear ? "shear"
                                                                       : "none";
  std::string held;
  if (setup.held_load > 0)
    held = fmt::format(" · confining stress {:.4g} MPa held", test.loading.confining_stress / 1e6);
  return label(kMargin, 30, "font-size=\"16\" font-weight=\"600\"", title) + label(kMargin, 50, kSoft, model) +
         label(kMargin, 70, "",
               fmt::format("first failure {} ({}) · breakage {}", load(result.first_failure_load), mode,
                           load(result.breakage_load))) +
         label(kMargin, 90, kSoft,
               (angle ? fmt::format("breakage line {:.1f}° from the load axis", *angle)
                      : std::string("not broken at the largest load")) +
                   held);
}

}  // namespace

std::vector<double> utilization(const LabResult& result) {
  std::vector<double> values;
  for (const Stress& stress : result.averaged_stress) {
    const PrincipalStress p = principal(stress);
    values.push_back(1 / result.rock.load_factor(p.s1, p.s3));
  }
  return values;
}

std::string lab_figure(const LabSetup& setup, const LabResult& result, const common::LabTest& test) {
  Canvas canvas{setup.outline[0], setup.outline[0]};
  for (const Vec2& v : setup.outline) {
    canvas.low = canvas.low.cwiseMin(v);
    canvas.high = canvas.high.cwiseMax(v);
  }
  const Vec2 extent = canvas.high - canvas.low;
  canvas.scale = kPanel / std::max(extent.x(), extent.y());
  canvas.left = kMargin;
  Canvas right = canvas;
  // Flat specimens stand below each other, others side by side.
  const bool below = extent.x() > 2 * extent.y();
  std::string second;
  double width = 0, height = 0;
  const auto shifted = [](const std::string& body, double dy) {
    return fmt::format("<g transform=\"translate(0 {:.1f})\">\n{}</g>\n", dy, body);
  };
  if (below) {
    const double down = canvas.bottom() - kHead + 20;
    second = shifted(fragments(right, setup, result.breakage), down);
    width = canvas.left + canvas.width() + kMargin + kLegend;
    height = std::max(canvas.bottom() + down + kMargin, kHead + 300);
  } else {
    right.left = canvas.left + canvas.width() + 2 * kMargin;
    second = fragments(right, setup, result.breakage);
    width = right.left + right.width() + kMargin + kLegend;
    height = canvas.bottom() + kMargin;
  }
  width = std::max(width, 740.0);
  height += kCaption;  // below the arrows
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
             "height=\"{1:.0f}\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"13\" fill=\"#1f2933\">\n"
             "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"white\"/>\n",
             width, height) +
         headline(setup, result, test, extent.y()) + field(canvas, result) +
         path(canvas.closed(setup.outline), "fill=\"none\" stroke=\"#1f2933\" stroke-width=\"1.2\"") +
         cracks(canvas, result.breakage.cracks) + arrows(canvas, setup, result.loads) + second +
         legend(width - kLegend, kHead + kMargin + 14) +
         label(kMargin, height - 10, std::string(kSoft) + " font-size=\"11\"",
               "colour: 1 / λ of the averaged stress at first failure (1: fails); orange: cracks; arrows: load") +
         "</svg>\n";
}

}  // namespace xfem
