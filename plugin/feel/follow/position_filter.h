// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spidar::follow {

/// Estimates the position of a player from its reports, which are rare and nearly always late. A
/// player cannot report a position before reaching it, but may report it late: mpv reports 24
/// positions a second, from 10 ms early to 12 ms late, VLC 2.7 a second, from 4 ms early to 114 ms
/// late. The filter therefore uses the report with the least delay. Times are of CLOCK_MONOTONIC.
class PositionFilter {
 public:
  /// The number of positions that VLC reports in 3 s.
  static constexpr size_t kKept = 8;
  /// No player reported as late as this in our measurements: a larger difference is a jump.
  static constexpr int64_t kMaxLate_ns = 150'000'000;
  /// This many positions in a row, each before the last, mean reverse playback: VLC reports 3/s.
  static constexpr int kBackward = 3;

  /// Begins at this position with `rate`, and discards earlier reports.
  void reset(int64_t now_ns, int64_t position_ns, double rate);
  /// Continues from the present position at another rate.
  void change_rate(int64_t now_ns, double rate);
  /// Adds a reported position. A repetition of the last one is ignored.
  void add(int64_t now_ns, int64_t position_ns);
  /// Adds a reported jump to this position. VLC also reports jumps when there was none.
  void add_jump(int64_t now_ns, int64_t position_ns);

  bool has_begun() const { return count_ > 0; }
  /// Whether each of the newest kBackward positions was before its predecessor, without a jump.
  bool runs_backwards() const { return backward_ >= kBackward; }
  /// When the player reported the newest position; 0 before the first one.
  int64_t newest_ns() const { return newest_ns_; }
  /// Returns the estimated position. Call reset() first.
  int64_t position_at(int64_t now_ns) const;

 private:
  /// The time at which a position of 0 would have been reached.
  int64_t begin_of(int64_t now_ns, int64_t position_ns) const;
  int64_t earliest_ns() const;
  void keep(int64_t begin_ns);
  void reset_after_jump(int64_t now_ns, int64_t position_ns);

  std::array<int64_t, kKept> begin_ns_{};
  size_t count_ = 0;  ///< since reset(); the last kKept are stored
  double rate_ = 1;
  int64_t position_ns_ = 0;  ///< the newest reported position
  int64_t newest_ns_ = 0;
  int backward_ = 0;        ///< positions in a row, each before the last
  bool jumped_ = false;     ///< whether the newest one differed by more than kMaxLate_ns
  bool is_target_ = false;  ///< whether the next position replaces all others after a reported jump
};

/// Returns by how much to shift a film that is `error_ns` behind the player, `passed_ns` after the
/// last shift. The shift is at most 2 % of that time, which nobody feels. While `is_settling`, in
/// the first second after a jump, hardly any force has been felt yet, so the shift may be half of
/// that time.
int64_t small_correction_ns(int64_t error_ns, int64_t passed_ns, bool is_settling);

}  // namespace spidar::follow
