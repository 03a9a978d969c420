#include "xfem/criterion/hoek_brown.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using xfem::FailureMode;
using xfem::HoekBrown;
using xfem::principal;
using xfem::PrincipalStress;
using xfem::Stress;
using xfem::Vec2;

namespace {

const HoekBrown kRock{150e6, 25};
constexpr double kPi = 3.14159265358979323846;

}  // namespace

TEST_CASE("Strength of the paper's rock at tabulated confinements", "[hoek_brown]") {
  const double table[][2] = {{0, 150},    {4, 197.65}, {30, 397.42}, {0.5, 156.62},
                             {1, 163.02}, {2, 175.21}, {10, 254.95}};
  for (const auto& row : table) {
    INFO("s3 = " << row[0] << " MPa");
    CHECK(kRock.strength(row[0] * 1e6) / 1e6 == Approx(row[1]).margin(0.005));
  }
  CHECK(kRock.tensile_strength() == Approx(6e6));
  CHECK(kRock.strength(-6e6) == Approx(-6e6));
  CHECK(kRock.strength(-7e6) == -7e6);
}

TEST_CASE("A state multiplied by its load factor lies on the envelope", "[hoek_brown]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 100000; ++k) {
    const double m = 1 + 34 * uniform(random);
    const HoekBrown rock{std::pow(10.0, 6 + 3 * uniform(random)), m};
    const double scale = std::pow(10.0, -3 + 12 * uniform(random));
    const double s3 = scale * (2 * uniform(random) - 1);
    const double d = scale * std::pow(10.0, 2 - 10 * uniform(random));
    const double s1 = s3 + d;
    const double factor = rock.load_factor(s1, s3);
    INFO("m " << m << " sci " << rock.sigma_ci << " s1 " << s1 << " s3 " << s3 << " factor " << factor);
    REQUIRE(factor > 0);
    // Squared form, in long double: (lambda d)^2 = sci^2 (m lambda s3 / sci + 1).
    const long double e = factor * (static_cast<long double>(s1) - s3) / rock.sigma_ci;
    const long double a = m * static_cast<long double>(factor) * s3 / rock.sigma_ci;
    REQUIRE(static_cast<double>(std::abs(e * e - a - 1) / (e * e + std::abs(a) + 1)) < 1e-14);
    REQUIRE(factor * s3 >= -rock.tensile_strength() * (1 + 1e-14));
    if (s3 > -0.5 * rock.tensile_strength() / factor) {
      REQUIRE(rock.strength(factor * s3) == Approx(factor * s1).epsilon(1e-9));
    }
  }
}

TEST_CASE("Load factor in the limits", "[hoek_brown]") {
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(kRock.load_factor(0, 0) == infinity);
  CHECK(kRock.load_factor(1e6, 1e6) == infinity);
  CHECK(kRock.load_factor(-1e6, -1e6) == Approx(6));
  CHECK(kRock.load_factor(-1, -1 - 1e-8) == Approx(6e6 / (1 + 1e-8)).epsilon(1e-12));
  CHECK(kRock.load_factor(-1 + 1e-8, -1) == Approx(6e6).epsilon(1e-12));
  CHECK(kRock.load_factor(1e6, 0) == Approx(150));
  // Pure tension fails just below the cut-off: lambda^2 s^2 + m sci s lambda - sci^2 = 0.
  CHECK(kRock.load_factor(0, -1) == Approx(0.5 * (-25 + std::sqrt(629.0)) * 150e6).epsilon(1e-12));
  // Centre of the Brazilian disc: s1 = 3 |s3|, at 2 m / (m + sqrt(m^2 + 64)) of the tensile strength.
  for (const double m : {9.0, 11.0, 25.0}) {
    const HoekBrown rock{150e6, m};
    CHECK(rock.load_factor(3, -1) / rock.tensile_strength() == Approx(2 * m / (m + std::sqrt(m * m + 64))));
  }
}

TEST_CASE("Failure mode changes at the tangent point", "[hoek_brown]") {
  const double t = 26 - 2 * std::sqrt(26.0);
  CHECK(t == Approx(15.8).margin(0.01));
  CHECK(kRock.mode(t * (1 - 1e-9), -1) == FailureMode::tension);
  CHECK(kRock.mode(t * (1 + 1e-9), -1) == FailureMode::shear);
  CHECK(kRock.mode(-1, -2) == FailureMode::tension);
  CHECK(kRock.mode(1, 0) == FailureMode::shear);
  CHECK(kRock.mode(0, 0) == FailureMode::none);
  CHECK(kRock.mode(5, 5) == FailureMode::none);
  CHECK(HoekBrown{1e8, 3}.mode(-2, -3) == FailureMode::shear);
  CHECK(HoekBrown{1e8, 7.9}.mode(3, -1) == FailureMode::shear);
  CHECK(HoekBrown{1e8, 8.1}.mode(3, -1) == FailureMode::tension);
}

TEST_CASE("Shear planes stand at pi/4 - phi/2 from s1, phi from the envelope's slope", "[hoek_brown]") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 2000; ++k) {
    const double angle = 2 * kPi * uniform(random);
    const double s3 = 1e6 * (40 * uniform(random) - 1);
    const double s1 = std::max(s3, 0.0) + 1e6 * (20 + 400 * uniform(random));
    const auto planes = kRock.planes({s1, s3, Vec2(std::cos(angle), std::sin(angle))});
    REQUIRE(planes.mode == FailureMode::shear);
    const double s3_failure = s3 * kRock.load_factor(s1, s3);
    const double step = 1e-4 * (s3_failure + 6e6);
    const double slope = (kRock.strength(s3_failure + step) - kRock.strength(s3_failure - step)) / (2 * step);
    const double phi = std::asin((slope - 1) / (slope + 1));
    const double theta = kPi / 4 - phi / 2;
    CHECK(theta == Approx(kPi / 2 - std::atan(std::sqrt(slope))).epsilon(1e-9));
    const Vec2 first(std::cos(angle + theta), std::sin(angle + theta));
    const Vec2 second(std::cos(angle - theta), std::sin(angle - theta));
    REQUIRE((planes.first - first).norm() < 1e-6);
    REQUIRE((planes.second - second).norm() < 1e-6);
  }
}

TEST_CASE("Tensile planes run along s1, hydrostatic ones at 45 degrees", "[hoek_brown]") {
  const auto tension = kRock.planes({2, -1, Vec2(0.6, 0.8)});
  CHECK(tension.mode == FailureMode::tension);
  CHECK((tension.first - Vec2(0.6, 0.8)).norm() == 0);
  CHECK((tension.second - Vec2(0.6, 0.8)).norm() == 0);
  const auto hydrostatic = kRock.planes({3, 3, Vec2(1, 0)});
  CHECK(std::abs(hydrostatic.first.x() - std::sqrt(0.5)) < 1e-15);
  CHECK(std::abs(hydrostatic.second.y() + std::sqrt(0.5)) < 1e-15);
}

TEST_CASE("Principal stresses and directions rebuild the tensor", "[hoek_brown]") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; k < 10000; ++k) {
    Stress s{uniform(random), uniform(random), uniform(random)};
    if (k % 5 == 0) s.xy = 0;
    if (k % 7 == 0) s.yy = s.xx;
    if (k % 11 == 0) s.xy *= 1e-12;
    const PrincipalStress p = principal(s);
    const Vec2 d = p.direction1;
    const Vec2 n = common::perpendicular(d);
    REQUIRE(p.s1 >= p.s3);
    REQUIRE(std::abs(d.norm() - 1) < 1e-15);
    REQUIRE(std::abs(p.s1 * d.x() * d.x() + p.s3 * n.x() * n.x() - s.xx) < 1e-15);
    REQUIRE(std::abs(p.s1 * d.y() * d.y() + p.s3 * n.y() * n.y() - s.yy) < 1e-15);
    REQUIRE(std::abs(p.s1 * d.x() * d.y() + p.s3 * n.x() * n.y() - s.xy) < 1e-15);
  }
  CHECK(principal(Stress{2, 2, 0}).direction1 == Vec2(1, 0));
  CHECK(principal(Stress{1, 2, 0}).direction1 == Vec2(0, 1));
  CHECK(principal(Stress{2, 1, 0}).direction1 == Vec2(1, 0));
}
