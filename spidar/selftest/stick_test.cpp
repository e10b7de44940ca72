// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/stick_test.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "spidar/loop/haptic_loop.h"

namespace spidar::selftest {
namespace {

constexpr double kRamp_s = 0.05, kPush_s = 0.15, kReturn_s = 0.3, kAverage_s = 0.02;
/// Slow drivers need up to this time before the device follows, and positions are smoothed.
constexpr double kSettle_s = 0.05;

bool average(ForceHold& hold, Eigen::Vector3d& position_m) {
  position_m.setZero();
  int readings = 0;
  const bool whole = hold.hold_for(kAverage_s, [&](const GripReading& reading) {
    position_m += reading.pose.position_m;
    ++readings;
    return true;
  });
  if (readings > 0) position_m /= readings;
  return whole;
}

struct Pushes {
  double moved_m = 0;  ///< the motion during the push
  /// The distance from the middle at the end of the push; the middle cancels in the mean.
  double place_m = 0;
  double back_m = 0;  ///< the motion back after the push
};

bool push(ForceHold& hold, const Eigen::Vector3d& force_N, Pushes& mean) {
  Eigen::Vector3d before_m, pushed_m, let_go_m, after_m;
  if (!average(hold, before_m) || !hold.ramp_to(force_N, kRamp_s) || !hold.hold_for(kPush_s) ||
      !average(hold, pushed_m) || !hold.ramp_to(Eigen::Vector3d::Zero(), kRamp_s) ||
      !hold.hold_for(kSettle_s) || !average(hold, let_go_m) || !hold.hold_for(kReturn_s) ||
      !average(hold, after_m)) {
    return false;
  }
  const Eigen::Vector3d along = force_N.normalized();
  const double pushed_by_m = along.dot(pushed_m - before_m),
               let_go_at_m = along.dot(let_go_m - before_m);
  // A strong spring has pulled the stick back when the force ends; without a spring, the stick
  // moves on until then.
  const Eigen::Vector3d farthest_m =
      std::abs(pushed_by_m) > std::abs(let_go_at_m) ? pushed_m : let_go_m;
  mean.moved_m += along.dot(farthest_m - before_m) / 4;
  mean.place_m += along.dot(farthest_m) / 4;
  mean.back_m += along.dot(farthest_m - after_m) / 4;
  return true;
}

/// In the time t, a stick with spring k and viscous friction c returns by the fraction 1 − exp(−k
/// t/c) of its displacement. In the time T of the push, a force F has moved the stick by (1 −
/// exp(−k T/c)) F/k; there, the spring pulls with the fraction 1 − exp(−k T/c) of F.
double spring_that_pulls_back(double fraction) {
  // The ramps at both ends of the push count half.
  constexpr double kPushed_s = kRamp_s + kPush_s + kAverage_s;
  constexpr double kReturned_s = kReturn_s + kAverage_s;  // between the middles of two averages
  return 1 - std::pow(1 - std::clamp(fraction, 0.0, 1.0), kPushed_s / kReturned_s);
}

}  // namespace

StickTest test_stick(Grip& grip, const Pace& pace, double push_N) {
  StickTest test;
  ForceHold hold(grip, pace);
  const GripAbilities can = grip.abilities();
  test.description = grip.description();
  const auto begin = [&] { return hold.ramp_to(Eigen::Vector3d::Zero(), HapticLoop::kEnergise_s); };
  test.complete = repeated(
      hold, [] { return true; }, begin);
  if (test.complete && !grip.reading().knows_pose()) {
    throw DeviceError(grip.name() + ": " + to_string(grip.reading().pose_fault));
  }
  for (size_t axis = 0; axis < test.moved_m.size(); ++axis) {
    if (!can.direction || !can.force[axis]) continue;
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
    Pushes mean;
    for (const double side : {1.0, -1.0, -1.0, 1.0}) {
      test.complete = test.complete && repeated(hold, begin, [&] {
                        return push(hold, side * push_N * along, mean);
                      });
    }
    test.moved_m[axis] = mean.moved_m;
    const double least = StickTest::kMin_m / std::abs(mean.place_m);
    test.least_spring[axis] = spring_that_pulls_back(least);
    const double back = mean.back_m / mean.place_m;
    if (std::abs(mean.moved_m) >= StickTest::kMin_m && back >= least) {
      test.spring[axis] = spring_that_pulls_back(back);
    }
  }
  hold.release();
  return test;
}

namespace {

std::string percent(double fraction) {
  return std::to_string(std::lround(100 * fraction)) + " %";
}

std::string axis_text(const StickTest& test, size_t axis, double reach_m) {
  const double moved_m = test.moved_m[axis];
  if (std::abs(moved_m) < StickTest::kMin_m) {
    return "does not move: no force arrives, or friction, a spring or a hand is stronger\n";
  }
  const std::string moves = std::string("moves ") + (moved_m > 0 ? "with" : "against") +
                            " the force, by " + percent(std::abs(moved_m) / reach_m) +
                            " of its way";
  const double spring = test.spring[axis];
  if (spring > 0) {
    return moves + "; a spring pulls it back with " + percent(spring) + " of the push\n";
  }
  return moves + ", and stays there: no spring of more than " + percent(test.least_spring[axis]) +
         " of the push\n";
}

/// Returns "flip=xy", which reverses the sides of `against` in comparison with `device`.
std::string flip_option(const std::string& device, const std::array<bool, 2>& against) {
  const size_t given = device.find(",flip=");
  const std::string before =
      given == std::string::npos
          ? ""
          : device.substr(given + 1, device.find(',', given + 1) - given - 1);
  std::string sides;
  for (const size_t axis : {0, 1}) {
    if ((before.find("xy"[axis], 5) != std::string::npos) != against[axis]) sides += "xy"[axis];
  }
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
    still = still || std::abs(test.moved_m[axis]) < StickTest::kMin_m;
    springs = springs || test.spring[axis] > 0;
    against[axis] = test.moved_m[axis] <= -StickTest::kMin_m;
  }
  if (against[0] || against[1]) {
    const std::string flip = flip_option(device, against);
    text += "Its driver pushes to the other side. Write " + flip;
    text += flip.front() == 'f' ? ": device=ff:PATH," + flip + "\n" : "\n";
  }
  if (still) {
    text +=
        "An axis that does not move is not tested. Let go of the stick, switch on its power\n"
        "supply and, if it has one, its high-torque mode, and try more strength:\n"
        "ff:PATH,gain=50. dmesg shows messages of its driver. If fftest and ffmvforce of the\n"
        "package joystick do not move it either, try Linux 6.15 or newer, whose hid-pidff drives\n"
        "more devices.\n";
  }
  if (springs) {
    text +=
        "A centring spring is switched off as far as the driver can. What still pulls back is a\n"
        "spring of metal or of the device's firmware, and adds to the force of the film. If the\n"
        "maker's program or a switch of the device can set it to zero, do that; otherwise more\n"
        "strength makes the film stand out from it: ff:PATH,gain=50\n";
  }
  return text;
}

}  // namespace spidar::selftest
