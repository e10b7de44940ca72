// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/stick_test.h"

#include "spidar/loop/haptic_loop.h"
#include "spidar/selftest/hold.h"

namespace spidar {
namespace {

constexpr double kRamp_s = 0.05, kPush_s = 0.15, kReturn_s = 0.3, kAverage_s = 0.02;

bool average(ForceHold& hold, Eigen::Vector3d& position_m) {
  position_m.setZero();
  int readings = 0;
  const bool whole = hold.stay(kAverage_s, [&](const GripReading& reading) {
    position_m += reading.pose.position_m;
    ++readings;
    return true;
  });
  if (readings > 0) position_m /= readings;
  return whole;
}

bool push(ForceHold& hold, const Eigen::Vector3d& force_N, double& moved_m) {
  Eigen::Vector3d before_m, after_m;
  if (!average(hold, before_m) || !hold.go(force_N, kRamp_s) || !hold.stay(kPush_s) ||
      !average(hold, after_m))
    return false;
  moved_m += force_N.normalized().dot(after_m - before_m);
  return hold.go(Eigen::Vector3d::Zero(), kRamp_s) && hold.stay(kReturn_s);
}

}  // namespace

StickTest test_stick(Grip& grip, const Pace& pace, double push_N) {
  StickTest test;
  ForceHold hold(grip, pace);
  const GripAbilities can = grip.abilities();
  test.complete = hold.go(Eigen::Vector3d::Zero(), HapticLoop::kEnergise_s);
  if (test.complete && !grip.reading().knows_pose())
    throw DeviceError(grip.name() + ": " + to_string(grip.reading().trouble));
  for (size_t axis = 0; axis < test.moved_m.size(); ++axis) {
    if (!can.direction || !can.force[axis]) continue;
    double moved_m = 0;
    for (const double side : {1.0, -1.0, -1.0, 1.0}) {
      const Eigen::Vector3d along = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
      test.complete = test.complete && push(hold, side * push_N * along, moved_m);
    }
    test.moved_m[axis] = moved_m / 4;
  }
  hold.go(Eigen::Vector3d::Zero(), HapticLoop::kRelease_s);
  return test;
}

}  // namespace spidar
