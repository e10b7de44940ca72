// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/timing/playback_sync.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "plugin/gobject/ref.h"

namespace spidar {

void PlaybackSync::add_reading(int64_t monotonic_ns, int64_t clock_ns) {
  if (readings_ > 0) {
    const double predicted = static_cast<double>(monotonic_ns - monotonic_ns_) * rate_;
    const int64_t error_ns = clock_ns - clock_ns_ - static_cast<int64_t>(predicted);
    if (std::llabs(error_ns) <= kJump_ns) {
      strays_ = 0;
    } else if (readings_ >= kEnough && ++strays_ < kLastingJump) {
      return;
    } else {
      forget();
    }
  }
  const size_t slot = readings_++ % kWindow;
  xy_[2 * slot] = static_cast<GstClockTime>(monotonic_ns);
  xy_[2 * slot + 1] = static_cast<GstClockTime>(clock_ns);
  monotonic_ns_ = monotonic_ns;
  clock_ns_ = clock_ns;
}

void PlaybackSync::fit() {
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
  // Uses the value of the line at the newest reading instead of the reading itself.
  const int64_t since_base_ns = monotonic_ns_ - static_cast<int64_t>(x_base);
  clock_ns_ = static_cast<int64_t>(base) +
              static_cast<int64_t>(std::llround(static_cast<double>(since_base_ns) * rate));
}

void PlaybackSync::watch_progress(int64_t monotonic_ns, int64_t clock_ns) {
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

void PlaybackSync::expect_base_time(GstElement* element) {
  constexpr int64_t kPatience_ns = 3'000'000'000;
  outdated_base_time_ = gst_element_get_base_time(element);
  outdated_until_ns_ = now_(now_user_) + kPatience_ns;
}

PlaybackClock PlaybackSync::observe(GstElement* element) {
  PlaybackClock result;
  const GstClockTime base_time = gst_element_get_base_time(element);
  const Ref<GstClock> clock(playing_ ? gst_element_get_clock(element) : nullptr);
  // Not playing: there must be no force.
  if (!clock || !GST_CLOCK_TIME_IS_VALID(base_time)) return result;
  const int64_t before_ns = now_(now_user_);
  if (base_time == outdated_base_time_ && before_ns < outdated_until_ns_) return result;
  outdated_base_time_ = GST_CLOCK_TIME_NONE;
  follow(clock.get());
  const GstClockTime time = gst_clock_get_time(clock.get());
  const int64_t after_ns = now_(now_user_);

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

}  // namespace spidar
