// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include "spidar/devices/force_feedback/packets.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/support/test.h"

namespace spidar::test {

/// Waits without a limit, because the test has one.
template <typename Condition>
void wait_for(const Condition& condition) {
  while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// A force that outlasts any test.
inline TimedWrench lasting(const Eigen::Vector3d& force_N, int64_t time_ns = 0) {
  TimedWrench entry;
  entry.time_ns = time_ns;
  entry.hold_ns = 3600 * kSecond_ns;
  entry.wrench.force_N = force_N;
  return entry;
}

/// A haptic session that plays a film of constant force, for force-feedback devices.
struct FeltPlayer {
  explicit FeltPlayer(const std::string& spec = "ff", bool guardian = false) {
    boards::Settings settings;
    settings.guardian = guardian;
    SessionSettings of_session;
    of_session.real_time = false;
    session = std::make_unique<HapticSession>(make_grip(spec, profile, settings), of_session);
    loop().set_playback_clock({HapticSession::monotonic_now_ns(), kSecond_ns, 1.0, true});
  }

  HapticLoop& loop() const { return session->loop(); }
  LoopSnapshot now() const { return loop().snapshot(); }
  void pause() const {
    loop().set_playback_clock({HapticSession::monotonic_now_ns(), 0, 1.0, false});
  }

  /// Returns when the loop applies the full force.
  void push(double x_N, double y_N) const {
    loop().cancel_scheduled();
    ASSERT_TRUE(loop().schedule(lasting({x_N, y_N, 0})));
    wait_for([&] {
      const Eigen::Vector3d& given_N = now().last.commanded.force_N;
      return given_N.x() == x_N && given_N.y() == y_N;
    });
  }

  const Profile profile = load_profile(kDefaultProfile);
  std::unique_ptr<HapticSession> session;
};

/// Whether a level, in newtons, is right to 1 % of the force and half a step of 3 N / 32767.
inline bool is_level(int level, double force_N, double of_N) {
  const double got_N = ff::kFullForce_N * level / ff::kFullLevel;
  return std::abs(got_N - force_N) <= 0.01 * of_N + 0.5 * ff::kFullForce_N / ff::kFullLevel;
}

}  // namespace spidar::test
