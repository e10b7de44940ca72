// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a device can do.
#pragma once

#include <array>

namespace spidar {

struct GripAbilities {
  /// Axes of the force that are felt: to the right, up, towards the viewer.
  std::array<bool, 3> force{true, true, true};
  bool torque = true;
  /// Otherwise only the size of the force is felt, in the axes that are felt.
  bool direction = true;
  std::array<bool, 3> position{true, true, true};  ///< axes in which it is measured
  double largest_force_N = 0;                      ///< in every direction that is felt
  int rate_Hz = 1000;                              ///< forces a second, at most
  int buttons = 0;                                 ///< at most 32
  /// How far the grip is to move from its middle to each side; 0: as far as in the profile.
  std::array<double, 3> half_room_m{};

  /// Whether the grip can touch a picture, of which the depth is felt.
  bool can_touch() const noexcept { return force[2] && position[2]; }
  /// Whether the grip can point at a place of a picture.
  bool can_point() const noexcept { return position[0] || position[1]; }
};

}  // namespace spidar
