// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Settings with which a board is operated.
#pragma once

namespace spidar {

/// When the counts are set to zero at the present position of the grip.
enum class CountZero {
  kByProfile,  ///< kNever for a profile with home offsets, otherwise kFirstOpen
  kFirstOpen,  ///< not when the board is reopened after it was lost
  kEveryOpen,
  kNever,  ///< the counts of the board, to which calibrated home offsets refer
};

struct BoardSettings {
  CountZero count_zero = CountZero::kByProfile;
  /// A separate process zeroes the motors when this one is killed.
  bool guardian = true;
  /// A separate thread makes the exchanges. Without it, exchange() blocks until the board has
  /// answered.
  bool threaded = true;
};

}  // namespace spidar
