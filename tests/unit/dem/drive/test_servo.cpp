// Oracle: closed forms of a PI loop around an elastic sample, sigma' = E (rate - drift).
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/drive/servo.hpp"

namespace {

constexpr double kPressure = 2e6;
constexpr double kRadius = 8;
constexpr double kDensity = 2000;

}  // namespace

TEST_CASE("the servo's gains follow from modulus, size and density, its limit also from the rate of the drive") {
  common::ServoOptions options;
  options.modulus = 1.25e8;  // waves of 250 m/s: 0.032 s from rim to centre
  const auto gains = dem::servo_gains(options, kPressure, kRadius, kDensity, 0.01);
  CHECK(gains.proportional == Approx(2.4 / (1.25e8 * 0.032)));
  CHECK(gains.integral == Approx(gains.proportional / 0.024));
  CHECK(gains.max_rate == Approx(0.05));
  CHECK(dem::servo_gains(options, kPressure, kRadius, kDensity, 0.03).max_rate == Approx(0.09));
  options.max_rate = 0.5;
  CHECK(dem::servo_gains(options, kPressure, kRadius, kDensity, 0.03).max_rate == 0.5);
}

TEST_CASE("a drift that grows steadily leaves the error drift' / ki, a constant one none, for soft and stiff samples") {
  for (const double modulus : {2e7, 1e8, 4e8}) {
    const auto gains = dem::servo_gains({}, kPressure, kRadius, kDensity, 0.02);
    const double dt = 8e-4;
    const double growth = 0.004;  // of the drift [1/s^2]: the lateral rate of a test builds up over seconds
    dem::Servo servo;
    double stress = kPressure, drift = 0, time = 0;
    double error = 0;
    for (; time < 3; time += dt) {
      servo.update(gains, kPressure, stress, dt);
      drift = growth * std::min(time, 2.0);
      stress += modulus * (servo.rate - drift) * dt;
      if (time < 2) error = kPressure - stress;
    }
    CHECK(error == Approx(growth / gains.integral).epsilon(0.02));
    CHECK(stress == Approx(kPressure).epsilon(1e-4));
    CHECK(servo.rate == Approx(drift).epsilon(1e-3));
  }
}

TEST_CASE("at its limit the servo's integral rests, so that it lets go at once") {
  const auto gains = dem::servo_gains({}, kPressure, kRadius, kDensity, 0.02);
  dem::Servo servo;
  for (int k = 0; k < 10000; ++k) servo.update(gains, kPressure, 0, 1e-3);
  CHECK(servo.rate == gains.max_rate);
  CHECK(std::abs(servo.integral) < gains.max_rate);
  servo.update(gains, kPressure, 2 * kPressure, 1e-3);
  CHECK(servo.rate < 0);
}

TEST_CASE(
    "however large the step, the stress is measured often enough for a sample four times as stiff as the servo's") {
  for (const double radius : {0.5, 2.0, 8.0}) {
    for (const double step : {1e-5, 1e-4, 4e-4}) {
      const auto gains = dem::servo_gains({}, kPressure, radius, kDensity, 0.02);
      const int interval = dem::servo_interval(gains, step);
      const double dt = interval * step;
      if (interval > 1) CHECK(dt <= 0.1 * gains.wave_time);
      if (interval < 10) CHECK(dt + step > 0.1 * gains.wave_time);
      if (step > 0.1 * gains.wave_time) continue;  // one step is the least
      dem::Servo servo;
      double stress = 0.999 * kPressure;
      for (double time = 0; time < 20 * gains.wave_time; time += dt) {
        servo.update(gains, kPressure, stress, dt);
        stress += 4e8 * servo.rate * dt;
      }
      CHECK(stress == Approx(kPressure).epsilon(1e-5));
    }
  }
}
