// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/play/session_record.h"

#include <algorithm>
#include <cmath>

#include "core/analysis/no_force_reason.h"

namespace {

enum MotionColumn : size_t {
  kRunningTime,
  kVelocity,
  kWanted = kVelocity + 2,
  kWantedRoll = kWanted + 3,
  kLimit
};

enum HapticColumn : size_t {
  kMonotonic,
  kLateness,
  kRunning,
  kFrame,
  kPlaying,
  kDevice,
  kDelivered,
  kDeliveredRoll = kDelivered + 3,
  kTension,
};

double seconds(int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

}  // namespace

std::vector<std::string> SessionRecord::motion_columns() {
  return {"running_time_ns", "velocity_x_px_s", "velocity_y_px_s", "force_x_N",
          "force_y_N",       "force_z_N",       "torque_z_Nm",     "limit"};
}

std::vector<std::string> SessionRecord::haptic_columns() {
  std::vector<std::string> columns = {"monotonic_ns",
                                      "lateness_ns",
                                      "running_ns",
                                      "frame_ns",
                                      "playing",
                                      "device",
                                      "delivered_force_x_N",
                                      "delivered_force_y_N",
                                      "delivered_force_z_N",
                                      "delivered_torque_z_Nm"};
  for (size_t i = 0; i < kStrings; ++i) columns.push_back("tension_" + std::to_string(i) + "_N");
  return columns;
}

void SessionRecord::add_motion(const TraceReader::Fields& row) {
  const int64_t frame_ns = to_integer(row[kRunningTime]);
  // Upwards is positive, as in the paper's figures; y of images points down.
  const double velocity_px_s[2] = {to_number(row[kVelocity]), -to_number(row[kVelocity + 1])};
  const double speed_px_s = std::hypot(velocity_px_s[0], velocity_px_s[1]);
  const double wanted_N[3] = {to_number(row[kWanted]), to_number(row[kWanted + 1]),
                              to_number(row[kWanted + 2])};
  const std::lock_guard lock(mutex_);
  if (frame_ns > last_frame_ns_ && last_frame_ns_ >= 0) {
    const double interval_s = seconds(frame_ns - last_frame_ns_);
    for (int i = 0; i < 2; ++i) position_px_[i] += velocity_px_s[i] * interval_s;
    numbers_.duration_s += interval_s;
  }
  last_frame_ns_ = frame_ns;
  ++numbers_.frames;
  ++numbers_.limits[std::string(row[kLimit])];
  numbers_.speed_px_s.add(speed_px_s);
  numbers_.wanted_N.add(std::hypot(wanted_N[0], wanted_N[1], wanted_N[2]));
  const double roll_Nm = to_number(row[kWantedRoll]);
  note_largest(wanted_N[2], roll_Nm);
  numbers_.frames_curve.add(seconds(frame_ns),
                            {position_px_[0], position_px_[1], velocity_px_s[0], velocity_px_s[1],
                             wanted_N[0], wanted_N[1], wanted_N[2], roll_Nm});
  now_.speed_px_s = speed_px_s;
}

void SessionRecord::add_haptic(const TraceReader::Fields& row) {
  const int64_t running_ns = to_integer(row[kRunning]);
  const std::lock_guard lock(mutex_);
  now_.device = row[kDevice];
  for (size_t i = 0; i < 3; ++i) now_.force_N[i] = to_number(row[kDelivered + i]);
  numbers_.lateness_ms.add(1e-6 * static_cast<double>(to_integer(row[kLateness])));
  if (row[kPlaying] != "1") return;

  now_.running_ns = running_ns;
  const double delivered_N = std::hypot(now_.force_N[0], now_.force_N[1], now_.force_N[2]);
  ++numbers_.ticks;
  if (delivered_N >= spidar::kFeltForce_N) ++numbers_.felt_ticks;
  numbers_.delivered_N.add(delivered_N);
  const double roll_Nm = to_number(row[kDeliveredRoll]);
  note_largest(now_.force_N[2], roll_Nm);
  std::array<double, 4 + kStrings> curve = {now_.force_N[0], now_.force_N[1], now_.force_N[2],
                                            roll_Nm};
  for (size_t i = 0; i < kStrings; ++i) curve[4 + i] = to_number(row[kTension + i]);
  numbers_.ticks_curve.add(seconds(running_ns), curve);
  numbers_.skew.felt(to_integer(row[kFrame]), to_integer(row[kMonotonic]));
}

void SessionRecord::note_largest(double depth_N, double roll_Nm) {
  numbers_.largest_depth_N = std::max(numbers_.largest_depth_N, std::abs(depth_N));
  numbers_.largest_roll_Nm = std::max(numbers_.largest_roll_Nm, std::abs(roll_Nm));
}

void SessionRecord::add_shown(int64_t running_ns, int64_t monotonic_ns) {
  const std::lock_guard lock(mutex_);
  ++numbers_.shown;
  numbers_.skew.shown(running_ns, monotonic_ns);
}

Now SessionRecord::now() const {
  const std::lock_guard lock(mutex_);
  return now_;
}
