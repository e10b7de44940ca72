// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which motor pulls, and which encoder reads, which string.
#pragma once

#include <array>
#include <string>

#include "core/api.h"
#include "spidar/profiles/profile.h"
#include "spidar/wiring/wiring_answers.h"

namespace spidar {

/// Of a channel of the board.
struct WiringChannel {
  int motor_string = -1;  ///< which string of the profile the motor pulls; −1: it does nothing
  bool motor_reversed = false;
  int encoder_string = -1;  ///< which string the encoder reads; −1: it stands still
  bool encoder_reversed = false;
  /// What the encoders said when the motor pulled was not it alone: the hand moved, or they said
  /// something else each time, or nothing that a motor of this device can do.
  bool unclear = false;
};

struct WiringReport {
  int count = 0;
  std::array<WiringChannel, kMaxStrings> channel{};
  /// Of the answers with those of the profile's geometry wired like that, 0 … 1.
  double correlation = 0;

  /// Below kMinCorrelation the answers do not look like this device's, however it is wired.
  static constexpr double kMinCorrelation = 0.8;
  /// And every motor's own answers do, in their directions and in their size.
  SPIDAR_API bool understood() const noexcept;
  /// All is as the profile says.
  SPIDAR_API bool as_profile() const noexcept;
  /// A profile can say what is wrong: signs, and strings that are at other channels, motor and
  /// encoder together.
  SPIDAR_API bool fixable() const noexcept;
};

/// Explains the answers by as few exchanged or reversed channels as will do.
///
/// A grip that a hand holds with compliance C moves by C W e_i ΔT when motor i pulls ΔT more, and
/// the strings get longer by −Wᵀ times that (W: structure matrix at the centre). The change of
/// lengths is known but for C: it is taken to be the same in all directions, with a share of
/// rotation that is tried out. The wiring whose expected answers correlate best with those measured
/// is looked for by exchanging two motors, two encoders or both, from the profile's on.
SPIDAR_API WiringReport judge_wiring(const Profile& profile, const WiringAnswers& answers);

/// The profile with what was found: signs, and strings in the order of the channels. Counts of a
/// calibrated profile are not those of the new one: it is to be calibrated again. `how` is for the
/// provenance. Throws std::invalid_argument when the report is not fixable().
SPIDAR_API Profile rewired_profile(const Profile& profile, const WiringReport& report,
                                   const std::string& how);

}  // namespace spidar
