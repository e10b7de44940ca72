// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Checks by moves of a hand whether encoders count as a profile says. The motors stay at zero.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "spidar/profiles/encoder_scale.h"
#include "spidar/profiles/profile.h"

namespace spidar::selftest {

/// The counts of the encoders while a hand held the grip at the centre, and at these positions.
struct HandMoves {
  struct Side {
    const char* name;
    Eigen::Vector3d direction;  ///< in the device frame, of length 1
  };
  static const std::array<Side, 6> kSides;

  double distance_m = 0;  ///< from the centre to each side, roughly
  std::array<EncoderScale::Counts, 7> counts{};
};

/// How far to move the grip: 3 cm, or in a small frame 0.3 of the way to the nearest side of the
/// box of the string exits.
double hand_move_m(const StringGeometry& geometry);

enum class EncoderSign {
  kAsProfile,
  kReversed,
  kStill,    ///< the encoder did not count
  kUnclear,  ///< the encoder counted up and down although its string was always paid out
};

/// Returns the sign for each string of the profile. Only positions to which a string is paid out by
/// at least 0.4 of the distance count, because without motors a string that was paid out stays
/// slack, and is not wound up again. An encoder has counted if its string is longer or shorter
/// there than at the centre by half of that length.
std::array<EncoderSign, kMaxStrings> encoder_signs(const Profile& profile, const HandMoves& moves);

bool encoders_agree(const Profile& profile, const HandMoves& moves);

}  // namespace spidar::selftest
