/// How a board is run.
#pragma once

namespace spidar {

/// When counts become zero where the grip is. Never means: as the board counts, which is what a
/// calibrated home offset refers to.
enum class CountZero {
  kFirstOpen,  ///< not when it is taken back after it was lost
  kEveryOpen,
  kNever,
};

struct BoardSettings {
  CountZero count_zero = CountZero::kFirstOpen;
  /// A process of its own zeroes the motors when this one is killed.
  bool guardian = true;
  /// Exchanges on a thread of their own. Without, exchange() blocks until the board has answered.
  bool threaded = true;
};

}  // namespace spidar
