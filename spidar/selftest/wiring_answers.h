// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures how the encoders answer when one motor after the other pulls.
#pragma once

#include <array>

#include <Eigen/Core>

#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/realtime/spsc_ring.h"
#include "spidar/selftest/hold.h"

namespace spidar::selftest {

/// A motor that has been pulled, to be shown while others are pulled.
struct PulledMotor {
  int motor = 0;
  double own_length_m = 0;  ///< the change of the length that its own encoder reads
  bool steady = true;       ///< see WiringAnswers::unsteady
};

struct WiringSettings {
  double pull_N = 0.5;   ///< above the minimum tension, up to the string's largest tension
  double ramp_s = 0.05;  ///< time to build up the pull, and to release it
  double settle_s = 0.1;
  double average_s = 0.1;
  /// Whether a motor that does nothing is tried with the other sign, on boards with negative volts.
  bool try_reversed = false;
  /// If not null, receives each motor after its pull, with a capacity for all tries.
  SpscRing<PulledMotor, 64>* pulled = nullptr;
};

struct WiringAnswers {
  /// The answer of an encoder (row) to the pull of a motor (column).
  Eigen::Matrix<double, kMaxStrings, kMaxStrings> counts = decltype(counts)::Zero();
  StringVector pulled_N = StringVector::Zero();  ///< the additional tension of each motor
  /// Whether the motor pulled with the sign opposite to the profile's.
  std::array<bool, kMaxStrings> reversed{};
  /// Whether the answers to the pulls of a motor differed at every attempt, because the hand moved.
  std::array<bool, kMaxStrings> unsteady{};
  bool complete = false;  ///< false if the pace ended the test early
};

/// Pulls one string after the other while a hand holds the grip loosely and the other strings have
/// their minimum tension. Pulls each string twice. Repeats both pulls, up to three times, if the
/// two answers differ, or if the counts at rest differ before and after a pull. Takes a second per
/// string with the default settings, and as much again when pulls are repeated or a motor is tried
/// with the other sign.
///
/// Throws DeviceError when the device is lost, or when a string runs away by 30 mm, further than a
/// hand gives way: the motor unwinds the string, or nobody holds the grip.
WiringAnswers measure_wiring(StringDevice& device, const Profile& profile, const Pace& pace,
                             const WiringSettings& settings = {});

void measure_again(StringDevice& device, const Profile& profile, const Pace& pace,
                   const WiringSettings& settings, const std::array<bool, kMaxStrings>& motors,
                   WiringAnswers& answers);

/// The smallest change of length that counts as an answer, m: above the tremor of a hand.
double smallest_answer_m(const Profile& profile);

}  // namespace spidar::selftest
