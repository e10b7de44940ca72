// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/wiring/stick_test.h"

#include "spidar/loop/haptic_loop.h"
#include "spidar/protocols/force_feedback.h"

namespace spidar {
namespace {

constexpr double kRamp_s = 0.05, kPush_s = 0.15, kReturn_s = 0.3, kAverage_s = 0.02;

/// The strings' view of one axis of a stick.
class Axis {
 public:
  Axis(const Profile& profile, int axis) : profile_(profile) {
    const StructureMatrix structure = structure_matrix(profile.geometry, {});
    for (int i = 0; i < profile.geometry.count; ++i) along_[i] = structure(axis, i);
  }

  /// Tensions that add half of the full force, to the positive or the negative side.
  StringVector pushed_N(double side) const {
    const StringVector pull = (side * along_).cwiseMax(0);
    return profile_.min_tension_N() + 0.5 * ff::kFullForce_N / pull.squaredNorm() * pull;
  }

  /// Position on the axis that the counts give, but for a constant.
  double position_m(const StringVector& counts) const {
    double sum_m = 0;
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const StringDrive& drive = profile_.drives[static_cast<size_t>(i)];
      sum_m -= along_[i] * drive.encoder_sign * drive.metres_per_count * counts[i];
    }
    return sum_m / along_.squaredNorm();
  }

 private:
  const Profile& profile_;
  StringVector along_ = StringVector::Zero();
};

bool average(StringHold& hold, StringVector& counts) {
  counts.setZero();
  int readings = 0;
  const bool whole = hold.stay(kAverage_s, [&](const DeviceReading& reading) {
    for (size_t i = 0; i < kMaxStrings; ++i) counts[static_cast<int>(i)] += reading.count[i];
    ++readings;
    return true;
  });
  if (readings > 0) counts /= readings;
  return whole;
}

bool push(StringHold& hold, const Profile& profile, const Axis& axis, double side,
          double& moved_m) {
  StringVector before, after;
  if (!average(hold, before) || !hold.go(axis.pushed_N(side), kRamp_s) || !hold.stay(kPush_s) ||
      !average(hold, after))
    return false;
  moved_m += side * (axis.position_m(after) - axis.position_m(before));
  return hold.go(profile.min_tension_N(), kRamp_s) && hold.stay(kReturn_s);
}

}  // namespace

StickTest test_stick(Device& device, const Profile& profile, const Pace& pace) {
  StickTest test;
  StringHold hold(device, profile, pace);
  const FeltParts felt = device.felt_parts();
  test.complete = hold.go(profile.min_tension_N(), HapticLoop::kEnergise_s);
  for (const int axis : {0, 1}) {
    if (!felt.direction || (axis == 1 && !felt.y)) continue;
    double moved_m = 0;
    for (const double side : {1.0, -1.0, -1.0, 1.0})
      test.complete = test.complete && push(hold, profile, Axis(profile, axis), side, moved_m);
    test.moved_m[static_cast<size_t>(axis)] = moved_m / 4;
  }
  hold.release();
  return test;
}

}  // namespace spidar
