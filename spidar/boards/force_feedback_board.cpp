// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/force_feedback_board.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace spidar {
namespace {

/// Full deflection of the stick, as a share of the distance from the centre to the strings' exits.
constexpr double kReach = 0.5;

}  // namespace

ForceFeedbackBoard::ForceFeedbackBoard(std::string name, const Profile& profile,
                                       std::unique_ptr<Transport> transport, Updates updates,
                                       const StickEffects::Options& options)
    : name_(std::move(name)),
      profile_(profile),
      rest_N_(profile.min_tension_N()),
      encoders_(profile),
      effects_(std::make_shared<StickEffects>(name_, std::move(transport), updates, options)) {
  for (int i = 0; i < profile.geometry.count; ++i)
    reach_m_ = reach_m_.cwiseMax(
        kReach * profile.geometry.exit_m[static_cast<size_t>(i)].head<2>().cwiseAbs());
}

Pose ForceFeedbackBoard::stick_pose() const noexcept {
  Pose pose;
  pose.position_m.head<2>() = reach_m_.cwiseProduct(effects_->place());
  return pose;
}

Eigen::Vector2d ForceFeedbackBoard::force_at(const Pose& pose,
                                             const MotorVolts& volts) const noexcept {
  StringVector tension_N = StringVector::Zero();
  double above = 0;  // how far tensions are above their minimum, as a share of it
  for (int i = 0; i < profile_.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile_.drives[k];
    tension_N[i] = volts.volt[k] * drive.motor_sign * drive.newtons_per_volt;
    if (rest_N_[i] > 0) above = std::max(above, tension_N[i] / rest_N_[i] - 1);
  }
  // The tension of the strings at rest is subtracted, and fades out when tensions rise above their
  // minimum to produce a force. Below the minimum the strings are being ramped to zero.
  StringVector rest_N = std::max(0.0, 1 - above) * rest_N_;
  rest_N = rest_N.cwiseMin(tension_N.cwiseMax(0));
  return structure_matrix(profile_.geometry, pose).topRows<2>() * (tension_N - rest_N);
}

LinkFault ForceFeedbackBoard::cycle(const MotorVolts& volts, DeviceReading& reading,
                                    int64_t) noexcept {
  // The volts were computed for the pose of the previous reading.
  const Eigen::Vector2d force_N = force_at(stick_pose(), volts);
  const bool pulls =
      std::any_of(volts.volt.begin(), volts.volt.end(), [](double volt) { return volt != 0; });
  const LinkFault fault = effects_->cycle(force_N, pulls);
  if (fault != LinkFault::kNone) return fault;
  encoders_.to_counts(string_lengths_m(profile_.geometry, stick_pose()), reading.count);
  reading.inputs = 0;
  reading.encoders = false;
  return LinkFault::kNone;
}

void ForceFeedbackBoard::open() {
  reopening_ = false;
  effects_->open();
  const ff::Description& found = effects_->description();
  felt_axes_ = effects_->effects() > 1 ? 2 : found.constant;
}

FeltParts ForceFeedbackBoard::felt_parts() const noexcept {
  const int axes = felt_axes_;
  return {true, axes != 1, false, false, axes != 0};
}

std::string ForceFeedbackBoard::description() const {
  const ff::Description& found = effects_->description();
  std::string text = found.name.data();
  if (effects_->gain() < 1) {
    char share[40];
    std::snprintf(share, sizeof share, " at %.0f %% of its strength", 100 * effects_->gain());
    text += share;
  }
  if (!found.constant)
    return text + ", rumble only: the strength of the force is felt, not its direction";
  if (felt_axes_ > 1) return text + ", force feedback on two axes";
  return text + ", force feedback on one axis: forces up and down are not felt";
}

}  // namespace spidar
