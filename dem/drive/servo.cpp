#include "dem/drive/servo.hpp"

#include <algorithm>
#include <cmath>

namespace dem {

void Servo::update(const ServoGains& gains, double target, double measured, double dt) {
  const double error = target - measured;
  const double grown = integral + gains.integral * error * dt;
  const double wanted = gains.proportional * error + grown;
  rate = std::clamp(wanted, -gains.max_rate, gains.max_rate);
  if (rate == wanted) integral = grown;
}

ServoGains servo_gains(const common::ServoOptions& options, double pressure, double radius, double density,
                       double drive_rate) {
  const double wave_time = radius / std::sqrt(options.modulus / density);
  ServoGains gains{};
  gains.proportional = 2.4 / (options.modulus * wave_time);
  gains.integral = gains.proportional / (0.75 * wave_time);
  const double enough = std::max(0.1 * pressure / (options.modulus * wave_time), 3 * drive_rate);
  gains.max_rate = options.max_rate > 0 ? options.max_rate : enough;
  gains.wave_time = wave_time;
  return gains;
}

int servo_interval(const ServoGains& gains, double time_step) {
  constexpr double kMost = 10;
  constexpr double kShareOfWave = 0.1;
  return static_cast<int>(std::max(1.0, std::min(kMost, kShareOfWave * gains.wave_time / time_step)));
}

}  // namespace dem
