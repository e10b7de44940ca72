// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds which motor pulls and which encoder reads which string, with a hand that may move.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>

#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/selftest/wiring_answers.h"

namespace spidar::selftest {

struct WiringChannel {
  /// The string of the profile that the motor pulls; −1: the motor does nothing.
  int motor_string = -1;
  bool motor_reversed = false;
  int encoder_string = -1;  ///< the string that the encoder reads; −1: the encoder stands still
  bool encoder_reversed = false;
  /// The answers to this motor's pulls are not those of one motor alone: the hand moved, the
  /// answers differed from pull to pull, or no motor of this device can cause them.
  bool unclear = false;
};

struct WiringReport {
  int count = 0;
  std::array<WiringChannel, kMaxStrings> channel{};
  /// The correlation of the answers with those expected for this wiring, 0 … 1.
  double correlation = 0;

  /// Below kMinCorrelation the answers do not look like those of this device, however it is wired.
  static constexpr double kMinCorrelation = 0.8;
  /// Whether the correlation is sufficient, and no motor is unclear.
  bool is_conclusive() const noexcept;
  bool as_profile() const noexcept;
  /// Whether a profile can describe the wiring: the wiring differs only in signs, and in strings
  /// that are at other channels, motor and encoder together.
  bool fixable() const noexcept;
};

/// Explains the answers by as few exchanged or reversed channels as possible.
///
/// When motor i pulls ΔT more, a grip that a hand holds with compliance C moves by C W e_i ΔT, and
/// the strings get longer by −Wᵀ times that motion (W: structure matrix at the centre). C is
/// unknown. It is assumed to be the same in all directions, with a fraction of rotation for which
/// several values are tried. The search for the wiring whose expected answers correlate best with
/// the measured ones starts at the profile's wiring, and exchanges two motors, two encoders or
/// both.
WiringReport judge_wiring(const Profile& profile, const WiringAnswers& answers);

/// Returns the profile with the measured signs, and with its strings in the order of the channels.
/// If strings or encoder signs change, the new profile loses its calibration, and the device must
/// be calibrated again. `how` describes the provenance. Throws std::invalid_argument when the
/// report is not fixable().
Profile rewired_profile(const Profile& profile, const WiringReport& report, const std::string& how);

/// How often test_wiring() measures at most: a moving hand makes different strings unclear each
/// time, a wrong wire always the same ones.
constexpr int kWiringTries = 3;

/// Runs measure_wiring() and judge_wiring(). If the report is not conclusive although something has
/// moved, calls `repeat` while all tensions are zero, and measures the unclear motors again, or all
/// motors if none is unclear; up to kWiringTries times in all. The report is not valid if the
/// answers are not complete. Throws DeviceError like measure_wiring().
std::pair<WiringAnswers, WiringReport> test_wiring(
    StringDevice& device, const Profile& profile, const Pace& pace, const WiringSettings& settings,
    const std::function<void(const WiringReport&)>& repeat = {});

/// Returns a text such as " 2, 5": the motors whose answers are unclear.
std::string unclear_motors(const WiringReport& report);

}  // namespace spidar::selftest
