// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Conversion from volts to digits of a D/A converter.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/protocols/uart_motor.h"

namespace spidar {

/// A D/A converter whose digit zero is zero volts.
struct DacScale {
  double digits_per_V = 1;
  int min_digit = 0;
  int max_digit = 0;

  /// Not a number is zero.
  int digit(double volt) const noexcept {
    const double digits = volt * digits_per_V;
    if (!std::isfinite(digits)) return 0;
    return static_cast<int>(std::lround(
        std::clamp(digits, static_cast<double>(min_digit), static_cast<double>(max_digit))));
  }
  double volt(int digits) const noexcept { return digits / digits_per_V; }
};

/// Scale of the profile's D/A converter, from zero to its largest voltage, for the CyVerse boards.
/// Their range is not published (inferred, because all published digits are positive).
inline DacScale unipolar_dac(const Profile& profile) noexcept {
  const int max_digit = (1 << profile.dac_bits) - 1;
  return {max_digit / profile.dac_max_V, 0, max_digit};
}

inline DacScale uart_dac() noexcept {
  return {uart_motor::kDigitsPerVolt, -uart_motor::kMaxDigit, uart_motor::kMaxDigit};
}

/// Throws DeviceError when the profile wants negative volts.
inline void require_positive_motors(const std::string& device, const Profile& profile) {
  for (int i = 0; i < profile.geometry.count; ++i) {
    if (profile.drives[static_cast<size_t>(i)].motor_sign < 0)
      throw DeviceError(device + ": profile \"" + profile.name +
                        "\" wants negative volts for string " + std::to_string(i) +
                        " (motor_sign), the board puts out positive ones; take a profile for a "
                        "usb-sh4 or usb-simple board, such as spidar-g6x3-v2-r");
  }
}

}  // namespace spidar
