// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <utility>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"
#include "spidar/loop/loop_time.h"

namespace spidar {

/// Converts the pipeline's clock to the haptic loop's: computes which running time is on the screen
/// at which moment of CLOCK_MONOTONIC. A sink shows a buffer at base time + running time + latency,
/// and the offset here includes the latency, so the running time presented is clock − base time −
/// offset.
///
/// Not thread-safe: the owner holds one lock around it.
class PlaybackSync {
 public:
  /// `now` reads CLOCK_MONOTONIC in nanoseconds, or a test's replacement.
  explicit PlaybackSync(std::function<int64_t()> now) : now_(std::move(now)) {}

  /// True from PAUSED→PLAYING to PLAYING→PAUSED.
  void set_playing(bool playing) {
    playing_ = playing;
    outdated_base_time_ = GST_CLOCK_TIME_NONE;
    reset_clock();
  }

  /// Call this when running time restarts (flushing seek): the element's base time is outdated
  /// until the pipeline has prerolled and distributes another one. Until then nothing is on the
  /// screen. A sink that does not preroll keeps its base time, which counts again after 3 s.
  void expect_base_time(GstElement* element) {
    constexpr int64_t kOutdated_ns = 3'000'000'000;
    outdated_base_time_ = gst_element_get_base_time(element);
    outdated_until_ns_ = now_() + kOutdated_ns;
  }

  /// The delay of the force after the running time of its frame; signed.
  void set_offset(GstClockTimeDiff offset_ns) { offset_ns_ = offset_ns; }

  /// The running time that the sink has stepped over: it shows later frames that much earlier.
  void set_skipped(int64_t skipped_ns) { skipped_ns_ = skipped_ns; }

  /// Reads the element's clock and returns the line through the readings so far. A clock other than
  /// the system's reads with jitter, so the line is fitted; a lasting jump begins another line.
  /// When a clock stands still, or can no longer be read, the picture stays on the screen, so the
  /// line is valid for kLongestStandstill_ns only.
  PlaybackClock observe(GstElement* element) {
    PlaybackClock result;
    const GstClockTime base_time = gst_element_get_base_time(element);
    const Ref<GstClock> clock(playing_ ? gst_element_get_clock(element) : nullptr);
    // While not playing there must be no force.
    if (!clock || !GST_CLOCK_TIME_IS_VALID(base_time)) return result;
    const int64_t before_ns = now_();
    if (base_time == outdated_base_time_ && before_ns < outdated_until_ns_) return result;
    outdated_base_time_ = GST_CLOCK_TIME_NONE;
    follow(clock.get());
    const GstClockTime time = gst_clock_get_time(clock.get());
    const int64_t after_ns = now_();

    // If this thread was interrupted during a reading, the time of the reading is uncertain.
    constexpr int64_t kMaxReading_ns = 200 * 1000;
    if (readings_ == 0 || after_ns - before_ns <= kMaxReading_ns) {
      add_reading(before_ns + (after_ns - before_ns) / 2, to_ns(time));
      fit();
    }
    watch_progress(before_ns, to_ns(time));
    result.monotonic_ns = monotonic_ns_;
    result.running_ns = clock_ns_ - to_ns(base_time) - offset_ns_ + skipped_ns_;
    result.rate = rate_;
    result.playing = true;
    result.valid_until_ns = before_ns + kLongestStandstill_ns - behind_ns_;
    return result;
  }

  /// How long a frame may stay. The clock of a sound card that is read in whole periods stands
  /// still for a shorter time.
  static constexpr int64_t kLongestStandstill_ns = 100 * 1000 * 1000;

 private:
  static constexpr size_t kWindow = 64;
  /// With fewer readings, jitter hides the drift: the newest one and the nominal rate are used.
  static constexpr size_t kEnough = 16;
  /// A reading further than this from the line is not jitter.
  static constexpr int64_t kJump_ns = 5 * 1000 * 1000;
  /// This many such readings in a row mean another clock or a step in it. Fewer come from a sound
  /// card's clock in the middle of an update: the clock stands still while the thread that feeds
  /// the card is preempted.
  static constexpr int kLastingJump = 5;

  static int64_t to_ns(GstClockTime t) {
    return GST_CLOCK_TIME_IS_VALID(t) ? static_cast<int64_t>(t) : 0;
  }
  void reset() {
    readings_ = 0;
    strays_ = 0;
  }
  void reset_clock() {
    reset();
    watched_ = false;
    behind_ns_ = 0;
  }
  /// Readings of another clock begin another line.
  void follow(const GstClock* clock) {
    if (clock != clock_) reset_clock();
    clock_ = clock;
  }
  void add_reading(int64_t monotonic_ns, int64_t clock_ns) {
    if (readings_ > 0) {
      const double predicted = static_cast<double>(monotonic_ns - monotonic_ns_) * rate_;
      const int64_t error_ns = clock_ns - clock_ns_ - static_cast<int64_t>(predicted);
      if (std::llabs(error_ns) <= kJump_ns) {
        strays_ = 0;
      } else if (readings_ >= kEnough && ++strays_ < kLastingJump) {
        return;
      } else {
        reset();
      }
    }
    const size_t slot = readings_++ % kWindow;
    xy_[2 * slot] = static_cast<GstClockTime>(monotonic_ns);
    xy_[2 * slot + 1] = static_cast<GstClockTime>(clock_ns);
    monotonic_ns_ = monotonic_ns;
    clock_ns_ = clock_ns;
  }
  /// Fits the line through the last readings, which removes the jitter of rate and newest reading.
  void fit() {
    // Real clocks drift by tens of ppm; a larger slope is jitter over too short a time.
    constexpr double kMaxDrift = 0.01;
    rate_ = 1.0;
    if (readings_ < kEnough) return;
    GstClockTime numerator = 0, denominator = 0, base = 0, x_base = 0;
    gdouble r_squared = 0;
    const guint n = static_cast<guint>(std::min(readings_, kWindow));
    if (!gst_calculate_linear_regression(xy_.data(), scratch_.data(), n, &numerator, &denominator,
                                         &base, &x_base, &r_squared) ||
        denominator == 0) {
      return;
    }
    const double rate = static_cast<double>(numerator) / static_cast<double>(denominator);
    if (!(std::fabs(rate - 1.0) < kMaxDrift)) return;
    rate_ = rate;
    // The line's value at the newest reading replaces the reading itself.
    const int64_t since_base_ns = monotonic_ns_ - static_cast<int64_t>(x_base);
    clock_ns_ = static_cast<int64_t>(base) +
                static_cast<int64_t>(std::llround(static_cast<double>(since_base_ns) * rate));
  }
  /// A clock that runs at less than half speed counts as one that stands still.
  void watch_progress(int64_t monotonic_ns, int64_t clock_ns) {
    if (watched_) {
      const int64_t passed_ns = monotonic_ns - watched_monotonic_ns_;
      // Going back is no progress, and a leap cannot count for more than the longest standstill.
      const int64_t progress_ns = std::clamp<int64_t>(clock_ns - watched_clock_ns_, 0,
                                                      std::max(passed_ns, kLongestStandstill_ns));
      behind_ns_ =
          std::clamp<int64_t>(behind_ns_ + passed_ns - 2 * progress_ns, 0, kLongestStandstill_ns);
    }
    watched_ = true;
    watched_monotonic_ns_ = monotonic_ns;
    watched_clock_ns_ = clock_ns;
  }

  std::function<int64_t()> now_;
  bool playing_ = false;
  GstClockTime outdated_base_time_ = GST_CLOCK_TIME_NONE;
  int64_t outdated_until_ns_ = 0;
  int64_t offset_ns_ = 0;
  int64_t skipped_ns_ = 0;

  const GstClock* clock_ = nullptr;  ///< only compared: the readings are of this clock
  // Readings (monotonic, clock) as gst_calculate_linear_regression() takes them.
  std::array<GstClockTime, 2 * kWindow> xy_{};
  std::array<GstClockTime, 2 * kWindow> scratch_{};
  size_t readings_ = 0;  ///< since reset(); the last kWindow are stored
  int strays_ = 0;       ///< readings left out since the newest stored one
  // clock = clock_ns_ + (t − monotonic_ns_) · rate_
  int64_t monotonic_ns_ = 0;
  int64_t clock_ns_ = 0;
  double rate_ = 1.0;

  // How far the clock has fallen behind half of its nominal speed.
  bool watched_ = false;
  int64_t watched_monotonic_ns_ = 0;
  int64_t watched_clock_ns_ = 0;
  int64_t behind_ns_ = 0;
};

}  // namespace spidar
