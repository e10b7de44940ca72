// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/grip/string_grip.h"

#include <utility>

#include "spidar/profiles/force_range.h"

namespace spidar {
namespace {

GripAbilities abilities_of(const Profile& profile) {
  GripAbilities abilities;
  abilities.largest_force_N = largest_force_N(profile);
  return abilities;
}

}  // namespace

StringGrip::StringGrip(const Profile& profile, Device& device)
    : profile_(profile),
      device_(device),
      traits_{true, true, profile.geometry.grip_radius_m(), profile.drive_lag_s},
      abilities_(abilities_of(profile)),
      watch_(profile),
      tension_command_(profile),
      tension_slew_(profile),
      heat_(profile) {}

StringGrip::StringGrip(const Profile& profile, std::unique_ptr<Device> device)
    : profile_(profile),
      owned_(std::move(device)),
      device_(*owned_),
      traits_{true, true, profile.geometry.grip_radius_m(), profile.drive_lag_s},
      abilities_(abilities_of(profile)),
      watch_(profile),
      tension_command_(profile),
      tension_slew_(profile),
      heat_(profile) {}

/// Only the home position of the grip is known.
void StringGrip::open() {
  device_.open();
  acknowledged_N_.setZero();
  watch_.reset();
  reading_.motion.reset();
  tension_command_.reset();
  tension_slew_.reset(acknowledged_N_);
  report();
}

void StringGrip::pass(double passed_s) noexcept {
  // The last acknowledged tensions have acted until now.
  heat_.pass(acknowledged_N_, passed_s);
  reading_.motor_heat = heat_.hottest();
}

void StringGrip::check_age(int64_t now_ns) noexcept {
  watch_.check_age(now_ns);
  reading_.trouble = watch_.trouble();
}

void StringGrip::pull(const GripCommand& command) noexcept {
  tension_command_.leave_out(watch_.faulty_string());
  const StructureMatrix W = structure_matrix(profile_.geometry, watch_.pose());
  StringVector wanted_N;
  if (command.fresh) {
    tension_command_.solve(W, command.wrench, heat_.limit_N());
    wanted_N = tension_command_.limit(W, command.limits, watch_.pose(), reading_.motion);
  } else {
    // Near the end of the ramp to rest the wrench may still be large. If it were solved for, the
    // tensions would not have enough time left to fall.
    const double pace = watch_.trusted() ? 1 : TensionCommand::kLostPace;
    wanted_N = tension_command_.fade(command.wrench, pace);
  }
  const StringVector limited_N =
      tension_slew_.apply(command.power * wanted_N, profile_, command.dt_s);
  reading_.tension_N = bound_tensions(limited_N, profile_);
  const Eigen::Matrix<double, 6, 1> delivered = W * reading_.tension_N;
  reading_.delivered = {delivered.head<3>(), delivered.tail<3>()};
  reading_.held_back = tension_command_.held_back();
}

ExchangeStatus StringGrip::exchange(const GripCommand& command) noexcept {
  pull(command);
  DeviceReading answer;
  const ExchangeStatus status = device_.exchange(to_volts(reading_.tension_N, profile_), answer);
  if (status == ExchangeStatus::kOk) {
    acknowledged_N_ = reading_.tension_N;
    see(answer, command);
  } else {
    // The motors may not have received this tick.
    reading_.tension_N = acknowledged_N_;
    tension_slew_.reset(acknowledged_N_);
    watch_.miss(command.now_ns);
  }
  report();
  return status;
}

void StringGrip::see(const DeviceReading& answer, const GripCommand& command) noexcept {
  const bool at_rest = command.wrench.stacked().isZero(0);
  watch_.see(answer, reading_.delivered, at_rest, command.now_ns);
  if (watch_.trusted())
    reading_.motion.see(watch_.pose(), watch_.located_ns());
  else
    reading_.motion.reset();
}

void StringGrip::report() noexcept {
  reading_.pose = watch_.pose();
  reading_.trouble = watch_.trouble();
  reading_.pose_residual_m = watch_.residual_m();
  reading_.faulty_string = watch_.faulty_string();
  reading_.pose_errors = watch_.pose_errors();
  reading_.string_faults = watch_.string_faults();
}

}  // namespace spidar
