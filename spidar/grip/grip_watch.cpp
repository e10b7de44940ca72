// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/grip/grip_watch.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// Allows for noise of the pose, and for the time between reading the encoders and the clock.
constexpr double kJumpMargin_m = 2e-3;

double reach_m(const StringGeometry& geometry) {
  double reach = 0;
  for (int i = 0; i < geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    // With motors inside the grip, the points on the grip enclose the exits instead of the other
    // way round.
    reach = std::max({reach, geometry.exit_m[k].cwiseAbs().maxCoeff(),
                      geometry.grip_m[k].cwiseAbs().maxCoeff()});
  }
  return reach;
}

}  // namespace

GripWatch::GripWatch(const Profile& profile)
    : profile_(profile),
      encoders_(profile),
      radius_m_(profile.geometry.grip_radius_m()),
      reach_m_(spidar::reach_m(profile.geometry)),
      solver_(profile.geometry, profile.max_pose_residual_m()) {}

void GripWatch::reset() noexcept {
  trusted_ = false;
  trouble_ = PoseTrouble::kNotYet;
  misses_ = 0;
  good_poses_ = 0;
  pose_ = {};
  residual_m_ = 0;
  faulty_string_ = -1;
  located_ = false;
  counted_ = frozen_ = false;
  solver_.reset();
}

void GripWatch::fail(PoseTrouble trouble) noexcept {
  good_poses_ = 0;
  if (++misses_ <= kMaxMisses && trusted_) return;
  trusted_ = false;
  trouble_ = trouble;
}

void GripWatch::miss(int64_t now_ns) noexcept {
  check_age(now_ns);
  fail(PoseTrouble::kNoReading);
}

void GripWatch::check_age(int64_t now_ns) noexcept {
  if (!trusted_ || now_ns - located_ns_ <= kPoseTimeout_ns) return;
  trusted_ = false;
  good_poses_ = 0;
  trouble_ = PoseTrouble::kNoReading;
}

PoseTrouble GripWatch::judge(const PoseResult& result, int64_t now_ns) const noexcept {
  if (result.status != PoseStatus::kSolved) return PoseTrouble::kNoFit;
  const Pose& pose = result.pose;
  const double turn_rad = 2 * std::acos(std::min(1.0, std::fabs(pose.orientation.w())));
  if (pose.position_m.cwiseAbs().maxCoeff() > reach_m_ || turn_rad > kMaxTurn_rad)
    return PoseTrouble::kOutside;
  if (!located_) return PoseTrouble::kNone;
  const double way_m = (pose.position_m - pose_.position_m).norm() +
                       radius_m_ * pose.orientation.angularDistance(pose_.orientation);
  const double passed_s = 1e-9 * static_cast<double>(now_ns - located_ns_);
  return way_m > kMaxSpeed_m_s * passed_s + kJumpMargin_m ? PoseTrouble::kJump : PoseTrouble::kNone;
}

bool GripWatch::is_frozen(const DeviceReading& reading, const Wrench& applied,
                          int64_t now_ns) noexcept {
  if (!reading.encoders) return false;
  const bool moved = !counted_ || reading.count != last_count_;
  if (moved) {
    counted_ = true;
    last_count_ = reading.count;
    at_last_change_ = applied;
  }
  const double change_N = std::hypot(
      (applied.force_N - at_last_change_.force_N).norm(),
      (applied.torque_Nm - at_last_change_.torque_Nm).norm() / std::max(radius_m_, 1e-3));
  if (moved || change_N < kFrozenForce_N) pushed_ns_ = now_ns;
  // At rest the force returns to its previous value, but dead counters stay dead.
  if (moved) frozen_ = false;
  if (now_ns - pushed_ns_ > kFrozenAfter_ns) frozen_ = true;
  return frozen_;
}

void GripWatch::see(const DeviceReading& reading, const Wrench& applied, bool may_trust,
                    int64_t now_ns) noexcept {
  const bool frozen = is_frozen(reading, applied, now_ns);
  const PoseResult result = solver_.solve(encoders_.lengths_m(reading.count));
  residual_m_ = result.residual_m;
  PoseTrouble trouble = judge(result, now_ns);
  if (trouble == PoseTrouble::kNone || trouble == PoseTrouble::kJump) {
    // The next poses are compared with the pose after a jump, because the grip may really be there.
    pose_ = result.pose;
    located_ = true;
    located_ns_ = now_ns;
  }
  if (trouble == PoseTrouble::kNone && frozen) trouble = PoseTrouble::kFrozen;
  if (trouble == PoseTrouble::kNone) {
    if (result.faulty_string >= 0 && result.faulty_string != faulty_string_) ++string_faults_;
    faulty_string_ = result.faulty_string;
    misses_ = 0;
    good_poses_ = std::min(good_poses_ + 1, kGoodPoses);
    if (good_poses_ == kGoodPoses && may_trust) trusted_ = true;
    return;
  }
  ++pose_errors_;
  // A single jump is enough: the previous pose is not the present one.
  if (trouble == PoseTrouble::kJump || trouble == PoseTrouble::kFrozen) misses_ = kMaxMisses;
  fail(trouble);
  // The grip may have moved far from the last pose: search from the centre.
  if (!trusted_ && trouble == PoseTrouble::kNoFit) solver_.search_from({});
}

}  // namespace spidar
