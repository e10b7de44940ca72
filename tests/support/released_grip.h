// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"

namespace spidar::test {

/// A grip of `mass_kg` without a hand, with only the friction of the strings.
inline GripModel released(const Profile& profile, double mass_kg) {
  GripModel model = grip_model_of(profile);
  // The inertia of a sphere grows with its mass.
  model.inertia_kg_m2 *= mass_kg / model.mass_kg;
  model.mass_kg = mass_kg;
  model.hand_stiffness_N_m = model.hand_stiffness_Nm_rad = 0;
  const double left = 0.05 / model.hand_damping_N_s_m;
  model.hand_damping_N_s_m *= left;
  model.hand_damping_Nm_s_rad *= left;
  return model;
}

/// The wrench of a film at a time in seconds.
using Film = std::function<Wrench(double)>;

/// A loop that plays a film on a simulated device while nobody holds its grip, and the true state
/// of the grip.
class PlayedGrip {
 public:
  PlayedGrip(const Profile& of, const GripModel& model, Film film, const SafetyLimits& limits = {})
      : profile(of),
        device(profile, SimulatedDevice::Time::kFixedStep, model),
        loop(std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device), limits)),
        mass_kg_(model.mass_kg),
        film_(std::move(film)) {
    for (int i = 0; i < profile.geometry.count; ++i)
      frame_m_ = frame_m_.cwiseMax(profile.geometry.exit_m[static_cast<size_t>(i)].cwiseAbs());
    loop->open();
    // The strings become taut first.
    run(0.25);
    loop->set_playback_clock({now_ns, 0, 1.0, true});
    begun_ns_ = now_ns;
  }

  void run(double seconds) {
    for (const int64_t end_ns = now_ns + std::llround(1e9 * seconds); now_ns < end_ns;) tick();
  }

  /// Frames are known 20 ms before they are shown.
  void tick() {
    if (begun_ns_ != INT64_MIN) {
      for (; next_ns_ <= now_ns - begun_ns_ + 20 * kTick_ns; next_ns_ += kFrame_ns)
        loop->schedule({next_ns_, 2 * kFrame_ns, film_(1e-9 * static_cast<double>(next_ns_))});
    }
    now_ns += kTick_ns;
    const FeltState before = device.felt();
    loop->tick(now_ns, now_ns);
    const FeltState felt = device.felt();
    fastest_m_s = std::max(fastest_m_s, felt.velocity_m_s.norm());
    strongest_N = std::max(strongest_N, felt.wrench.force_N.norm());
    for (int axis = 0; axis < 3; ++axis) {
      const bool was_inside = std::abs(before.pose.position_m[axis]) < frame_m_[axis];
      if (!was_inside || std::abs(felt.pose.position_m[axis]) < frame_m_[axis]) continue;
      // The grip has hit the frame within this millisecond.
      const double speed_m_s = before.velocity_m_s[axis];
      hardest_J = std::max(hardest_J, 0.5 * mass_kg_ * speed_m_s * speed_m_s);
    }
  }

  LoopSnapshot snapshot() const { return loop->snapshot(); }

  const Profile profile;
  SimulatedDevice device;
  std::unique_ptr<HapticLoop> loop;
  int64_t now_ns = 0;
  // The largest true values of the grip so far.
  double fastest_m_s = 0;
  double hardest_J = 0;  ///< of a blow against the frame
  double strongest_N = 0;

 private:
  static constexpr int64_t kFrame_ns = 4 * kTick_ns;

  const double mass_kg_;
  const Film film_;
  Eigen::Vector3d frame_m_ = Eigen::Vector3d::Zero();
  int64_t begun_ns_ = INT64_MIN;
  int64_t next_ns_ = 0;
};

/// `force_N`, switched on and off or (`both_ways`) reversed at `rate_Hz`; 0: constant.
inline Film pulses(const Eigen::Vector3d& force_N, double rate_Hz, bool both_ways) {
  return [=](double time_s) {
    const bool on = rate_Hz <= 0 || std::fmod(time_s * rate_Hz, 1.0) < 0.5;
    return Wrench{on ? force_N : (both_ways ? -1.0 : 0.0) * force_N, Eigen::Vector3d::Zero()};
  };
}

}  // namespace spidar::test
