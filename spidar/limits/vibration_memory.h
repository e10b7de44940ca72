// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "spidar/limits/vibration_budget.h"

namespace spidar {

/// A time on two clocks: one that runs since the start of the computer and cannot be set, and UTC.
struct Moment {
  int64_t since_boot_ns = 0;  ///< CLOCK_BOOTTIME, which continues while the computer sleeps
  std::string boot;           ///< identifies that start; empty if unknown
  int64_t utc_ns = 0;

  static Moment now();
};

/// The time that has certainly passed from `then` to `now`, never negative. If the computer has
/// restarted in between, this is the larger of the time since the restart and the difference in
/// UTC.
int64_t passed_ns(const Moment& then, const Moment& now) noexcept;

/// Stores the state of the user's VibrationBudget in a file, which later programs and programs that
/// run at the same time share. Any thread may call all functions.
class VibrationMemory {
 public:
  /// The time until a half-empty store is full again. This time is assumed if the file cannot be
  /// used and this process has no earlier entry.
  static constexpr auto kUnknown_ns = static_cast<int64_t>(1e9 * VibrationBudget::kStore_m2_s3 / 2 /
                                                           VibrationBudget::kRefill_m2_s4);

  /// With an empty `file`, the state is lost with this object; `why_no_file` says why there is no
  /// file, unless the caller wants none.
  explicit VibrationMemory(std::string file, std::string why_no_file = {})
      : file_(std::move(file)), why_no_file_(std::move(why_no_file)) {}

  /// The memory of the user, in the folder SPIDAR_STATE or, if that is not set, in
  /// $XDG_STATE_HOME/gst-spidar (user_folder()). If SPIDAR_STATE is empty, a memory of this process
  /// only.
  static VibrationMemory& of_user();

  /// Adds the vibration since the last call, given as the time that refilling it takes, and returns
  /// the time until the store is full again.
  int64_t add(int64_t taken_ns, const Moment& now = Moment::now());
  /// Why the file could not be used at some time, and what was assumed instead; empty if it always
  /// could.
  std::string error() const;

 private:
  struct Entry {
    Moment at;
    int64_t empty_ns = 0;  ///< from then until the store is full again

    int64_t left_ns(const Moment& now) const noexcept;
  };

  static std::optional<Entry> parse(const std::string& text);
  static std::string text_of(const Entry& entry);

  const std::string file_, why_no_file_;
  mutable std::mutex mutex_;
  std::optional<Entry> last_;  ///< the newest entry of this process
  std::string error_;
};

/// A thread that stores the vibration of a running loop in the memory, and tells the budget of the
/// loop how much other programs have added.
class VibrationKeeper {
 public:
  /// Restores `budget` from the memory.
  VibrationKeeper(VibrationBudget& budget, VibrationMemory& memory);
  /// Call this when the loop has ended.
  ~VibrationKeeper();

 private:
  void keep();

  VibrationBudget& budget_;
  VibrationMemory& memory_;
  int64_t kept_ns_ = 0;  ///< part of budget_.taken_ns() that is stored
  std::mutex mutex_;
  std::condition_variable ended_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace spidar
