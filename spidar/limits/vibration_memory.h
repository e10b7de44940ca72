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

/// A time on two clocks of the kernel, of which only the second can be set.
struct Moment {
  int64_t since_boot_ns = 0;  ///< CLOCK_BOOTTIME, which continues while the computer sleeps
  std::string boot;           ///< identifies this start of the computer; empty: unknown
  int64_t utc_ns = 0;

  static Moment now();
};

/// The time that has certainly passed between the two, never negative. Across a restart of the
/// computer, the larger one of the time since the restart and the difference in UTC.
int64_t passed_ns(const Moment& then, const Moment& now) noexcept;

/// Stores the state of the user's VibrationBudget in a file, for later programs and for those that
/// run at the same time. Any thread.
class VibrationMemory {
 public:
  /// The time until a half-empty store is full again, which is assumed if the file cannot be used
  /// and nothing is known.
  static constexpr auto kUnknown_ns = static_cast<int64_t>(1e9 * VibrationBudget::kStore_m2_s3 / 2 /
                                                           VibrationBudget::kRefill_m2_s4);

  /// Without a file, the state is lost with this object. If that is not intended, `why_no_file`
  /// says why there is no file.
  explicit VibrationMemory(std::string file, std::string why_no_file = {})
      : file_(std::move(file)), why_no_file_(std::move(why_no_file)) {}

  /// The memory of the user, in $XDG_STATE_HOME/gst-spidar (user_folder()) or, if SPIDAR_STATE is
  /// set, in that folder; if SPIDAR_STATE is empty, a memory of this process only.
  static VibrationMemory& of_user();

  /// Adds the vibration since the last call, as the time that refilling takes, and returns the time
  /// until the store is full again.
  int64_t add(int64_t taken_ns, const Moment& now = Moment::now());
  /// Why the file was not used, and what is assumed instead; empty if it was.
  std::string error() const;

 private:
  struct Entry {
    Moment at;
    int64_t empty_ns = 0;  ///< time until the store is full again

    int64_t left_ns(const Moment& now) const noexcept;
  };

  static std::optional<Entry> parse(const std::string& text);
  static std::string text_of(const Entry& entry);

  const std::string file_, why_no_file_;
  mutable std::mutex mutex_;
  std::optional<Entry> last_;  ///< the newest entry of this process
  std::string error_;
};

/// Keeps the memory up to date while a loop runs, in a thread of its own.
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
  int64_t kept_ns_ = 0;  ///< stored part of the budget's vibration
  std::mutex mutex_;
  std::condition_variable ended_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace spidar
