// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/stick_report.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace spidar {
namespace {

std::string percent(double fraction) {
  return std::to_string(std::lround(100 * fraction)) + " %";
}

std::string axis_text(const StickTest& test, size_t axis, double reach_m) {
  const double moved_m = test.moved_m[axis];
  if (std::abs(moved_m) < StickTest::kLeast_m)
    return "does not move: no force arrives, or friction, a spring or a hand is stronger\n";
  const std::string moves = std::string("moves ") + (moved_m > 0 ? "with" : "against") +
                            " the force, by " + percent(std::abs(moved_m) / reach_m) +
                            " of its way";
  const double spring = test.spring[axis];
  if (spring > 0)
    return moves + "; a spring pulls it back with " + percent(spring) + " of the push\n";
  return moves + ", and stays there: no spring of more than " + percent(test.least_spring[axis]) +
         " of the push\n";
}

/// "flip=xy" so that the sides of `against` are turned round in comparison with `device`.
std::string flip_option(const std::string& device, const std::array<bool, 2>& against) {
  const size_t given = device.find(",flip=");
  const std::string before =
      given == std::string::npos
          ? ""
          : device.substr(given + 1, device.find(',', given + 1) - given - 1);
  std::string sides;
  for (const size_t axis : {0, 1})
    if ((before.find("xy"[axis], 5) != std::string::npos) != against[axis]) sides += "xy"[axis];
  return sides.empty() ? "no " + before : "flip=" + sides;
}

}  // namespace

std::string stick_report(const StickTest& test, const GripAbilities& can,
                         const Eigen::Vector2d& reach_m, const std::string& device) {
  constexpr std::array<const char*, 2> kNames{"right    ", "up       "};
  std::string text;
  bool still = false, springs = false;
  std::array<bool, 2> against{};
  for (size_t axis = 0; axis < kNames.size(); ++axis) {
    if (!can.force[axis]) continue;
    text += kNames[axis] + axis_text(test, axis, reach_m[static_cast<Eigen::Index>(axis)]);
    still = still || std::abs(test.moved_m[axis]) < StickTest::kLeast_m;
    springs = springs || test.spring[axis] > 0;
    against[axis] = test.moved_m[axis] <= -StickTest::kLeast_m;
  }
  if (against[0] || against[1]) {
    const std::string flip = flip_option(device, against);
    text += "Its driver pushes to the other side. Write " + flip;
    text += flip.front() == 'f' ? ": device=ff:PATH," + flip + "\n" : "\n";
  }
  if (still)
    text +=
        "An axis that does not move is not tested. Let go of the stick, switch on its power\n"
        "supply and, if it has one, its high-torque mode, and try more strength:\n"
        "ff:PATH,gain=50. dmesg shows messages of its driver. If fftest and ffmvforce of the\n"
        "package joystick do not move it either, try Linux 6.15 or newer, whose hid-pidff drives\n"
        "more devices.\n";
  if (springs)
    text +=
        "A centring spring is switched off as far as the driver can. What still pulls back is a\n"
        "spring of metal or of the device's firmware, and adds to the force of the film. If the\n"
        "maker's program or a switch of the device can set it to zero, do that; otherwise more\n"
        "strength makes the film stand out from it: ff:PATH,gain=50\n";
  return text;
}

}  // namespace spidar
