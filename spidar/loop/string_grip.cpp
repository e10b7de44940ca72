// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/string_grip.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/force/motion_rendering.h"

namespace spidar {
namespace {

double reach_m(const StringGeometry& geometry) {
  double reach = 0;
  for (int i = 0; i < geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    // With motors inside the grip, the points on the grip enclose the exits, not vice versa.
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
      solver_(profile.geometry, profile.max_pose_residual_m()),
      gate_(0.5 * profile.max_pose_residual_m()) {}

void GripWatch::reset() noexcept {
  trust_ = {};
  pose_ = {};
  residual_m_ = 0;
  faulty_string_ = -1;
  counted_ = frozen_ = follows_ = false;
  gate_.reset();
  solver_.reset();
}

PoseFault GripWatch::judge(const PoseResult& result, bool jumps) const noexcept {
  if (result.status != PoseStatus::kSolved) return PoseFault::kNoFit;
  const Pose& pose = result.pose;
  const double turn_rad = 2 * std::acos(std::min(1.0, std::fabs(pose.orientation.w())));
  if (turn_rad > kMaxTurn_rad) return PoseFault::kTurned;
  if (pose.position_m.cwiseAbs().maxCoeff() > reach_m_) return PoseFault::kOutside;
  return jumps ? PoseFault::kJump : PoseFault::kNone;
}

bool GripWatch::is_frozen(const DeviceReading& reading, const GripCommand& command) noexcept {
  if (!counted_ || reading.count != last_count_) {
    counted_ = true;
    last_count_ = reading.count;
    at_last_change_ = command.wrench;
    pushed_s_ = 0;
    frozen_ = false;
  }
  const Wrench change = command.wrench - at_last_change_;
  const double change_N =
      std::hypot(change.force_N.norm(), change.torque_Nm.norm() / std::max(radius_m_, 1e-3));
  // A force that shakes and passes the old value on its way does not reset the time.
  if (change_N >= kFeltForce_N) {
    pushed_s_ += std::min(1.0, change_N / kFrozenForce_N) * command.dt_s;
  }
  // After the force has returned to its previous value at rest, dead counters still count as dead.
  if (pushed_s_ > kFrozenAfter_s) frozen_ = true;
  return frozen_;
}

void GripWatch::update(const DeviceReading& reading, const GripCommand& command) noexcept {
  const int64_t read_ns = PoseTrust::time_of(reading.read_ns, command.now_ns);
  const bool frozen = is_frozen(reading, command);
  const StringVector lengths_m = encoders_.lengths_m(reading.count);
  if (!gate_.accept(lengths_m, read_ns, faulty_string_)) {
    ++pose_errors_;
    return trust_.fail(PoseFault::kJump);
  }
  const PoseResult result = solver_.solve(lengths_m);
  residual_m_ = result.residual_m;
  // A rotation counts as the displacement of the points at which the strings are tied.
  const double moved_m = (result.pose.position_m - pose_.position_m).norm() +
                         radius_m_ * result.pose.orientation.angularDistance(pose_.orientation);
  const bool jumps = trust_.is_jump(moved_m, read_ns);
  follows_ = result.status == PoseStatus::kSolved && !jumps;
  PoseFault fault = judge(result, jumps);
  if (follows_ || fault == PoseFault::kJump) {
    // The next poses are compared with the pose after a jump, because the grip may really be there.
    pose_ = result.pose;
    trust_.locate(read_ns);
  }
  if (fault == PoseFault::kNone && frozen) fault = PoseFault::kFrozen;
  if (fault == PoseFault::kNone) {
    if (result.faulty_string >= 0 && result.faulty_string != faulty_string_) ++string_faults_;
    faulty_string_ = result.faulty_string;
    return trust_.succeed(command.wrench.stacked().isZero(0));
  }
  ++pose_errors_;
  // A single jump ends trust, because the previous pose is no longer true.
  trust_.fail(fault, fault == PoseFault::kJump || fault == PoseFault::kFrozen);
  // The grip may have moved far from the last pose, so the search starts from the centre.
  if (!trust_.trusted() && fault == PoseFault::kNoFit) solver_.search_from({});
}

namespace {

GripAbilities abilities_of(const Profile& profile, const GripTraits& traits) {
  GripAbilities abilities;
  abilities.largest_force_N = std::min(largest_force_N(profile), traits.most_force_N());
  return abilities;
}

}  // namespace

StringGrip::StringGrip(const Profile& profile, StringDevice& device)
    : Grip(device),
      profile_(profile),
      device_(device),
      traits_{true, true, profile.geometry.grip_radius_m(), profile.drive_lag_s, profile.body()},
      abilities_(abilities_of(profile, traits_)),
      home_lengths_m_(string_lengths_m(profile.geometry, {})),
      watch_(profile),
      chain_(profile) {}

StringGrip::StringGrip(const Profile& profile, std::unique_ptr<StringDevice> device)
    : StringGrip(profile, *device) {
  owned_ = std::move(device);
}

/// The first reading is compared with the home position, which is the only known pose.
void StringGrip::open() {
  device_.open();
  watch_.reset();
  reading_.motion.reset();
  chain_.reset();
  report();
}

void StringGrip::advance(double passed_s) noexcept {
  chain_.heat(passed_s);
  reading_.motor_heat = chain_.hottest();
}

void StringGrip::check_age(int64_t now_ns) noexcept {
  watch_.check_age(now_ns);
  reading_.pose_fault = watch_.fault();
}

void StringGrip::pull(const GripCommand& command) noexcept {
  const StructureMatrix W = structure_matrix(profile_.geometry, watch_.pose());
  reading_.tension_N = chain_.apply(
      {command, W, watch_.pose(), reading_.motion, watch_.trusted(), watch_.faulty_string()});
  const Eigen::Matrix<double, 6, 1> delivered = W * reading_.tension_N;
  reading_.delivered = {delivered.head<3>(), delivered.tail<3>()};
  const Eigen::Matrix<double, 6, 1> at_rest = command.power * (W * profile_.min_tension_N());
  reading_.at_rest = {at_rest.head<3>(), at_rest.tail<3>()};
  reading_.stored_J = profile_.min_tension_N().dot(
      string_lengths_m(profile_.geometry, watch_.pose()) - home_lengths_m_);
  reading_.held_back = chain_.held_back();
}

LinkFault StringGrip::exchange(const GripCommand& command) noexcept {
  pull(command);
  DeviceReading answer;
  const LinkFault fault = device_.exchange(to_volts(reading_.tension_N, profile_), answer);
  if (fault == LinkFault::kNone) {
    chain_.acknowledge(reading_.tension_N);
    update(answer, command);
  } else {
    reading_.tension_N = chain_.undo();
    watch_.miss(command.now_ns);
  }
  report();
  return fault;
}

void StringGrip::update(const DeviceReading& answer, const GripCommand& command) noexcept {
  const int left_out = watch_.faulty_string();
  watch_.update(answer, command);
  // Poses that were computed without a string that fits now may have been wrong, so the difference
  // to this pose is no motion.
  if (left_out >= 0 && watch_.faulty_string() != left_out) reading_.motion.reset();
  if (watch_.trusted() || watch_.follows()) {
    reading_.motion.update(watch_.pose(), watch_.located_ns());
  } else {
    reading_.motion.reset();
  }
}

void StringGrip::report() noexcept {
  reading_.pose = watch_.pose();
  reading_.pose_fault = watch_.fault();
  reading_.pose_residual_m = watch_.residual_m();
  reading_.faulty_string = watch_.faulty_string();
  reading_.pose_errors = watch_.pose_errors();
  reading_.string_faults = watch_.string_faults();
}

}  // namespace spidar
