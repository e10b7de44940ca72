// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How a board is run.
#pragma once

namespace spidar {

/// When counts become zero where the grip is.
enum class CountZero {
  kByProfile,  ///< kNever for a profile with home offsets, else kFirstOpen
  kFirstOpen,  ///< not when the board is taken back after it was lost
  kEveryOpen,
  kNever,  ///< as the board counts, which is what calibrated home offsets refer to
};

struct BoardSettings {
  CountZero count_zero = CountZero::kByProfile;
  /// A process of its own zeroes the motors when this one is killed.
  bool guardian = true;
  /// Exchanges on a thread of their own. Without, exchange() blocks until the board has answered.
  bool threaded = true;
};

}  // namespace spidar
