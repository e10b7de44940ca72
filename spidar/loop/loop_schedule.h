// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "core/force/wrench_timeline.h"
#include "core/track/track_reader.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/realtime/spsc_ring.h"

namespace spidar {

/// Sends each wrench earlier by the lag of the device, as far as the film is known in advance. If
/// it is known for less time than the lag, the device renders all wrenches equally late.
class LookAhead {
 public:
  /// Returns the running time whose wrench to send at `running_ns`, with wrenches known up to
  /// `known_ns`. The result hardly ever decreases, and exceeds `known_ns` only when `running_ns`
  /// does: then the film has stopped, and the wrench expires.
  int64_t ask_for(int64_t running_ns, int64_t lag_ns, int64_t known_ns) noexcept {
    const int64_t passed_ns = std::clamp<int64_t>(running_ns - before_ns_, 0, kLongest_ns);
    before_ns_ = running_ns;
    const int64_t ahead_ns = known_ns > running_ns ? known_ns - running_ns : 0;
    ahead_ns_ = std::min(ahead_ns_ + passed_ns / kCatchUp, ahead_ns);
    const int64_t lead_ns = std::min(ahead_ns_, lag_ns);
    late_ns_ = lag_ns - lead_ns;
    return running_ns + lead_ns;
  }
  /// Call this when no wrench is known any more.
  void reset() noexcept {
    ahead_ns_ = kFarAhead_ns;
    late_ns_ = 0;
  }
  /// How much later than its frame the device renders a wrench.
  int64_t late_ns() const noexcept { return late_ns_; }

 private:
  /// Between two frames, the time for which the film is known ahead shrinks, and its minimum
  /// counts. When it has grown, wrenches follow one another faster by 1/kCatchUp, 10 %, until the
  /// delay is made up for.
  static constexpr int64_t kCatchUp = 10;
  /// The longest step of time that counts, which limits the effect of a jump.
  static constexpr int64_t kLongest_ns = 10'000'000;
  static constexpr int64_t kFarAhead_ns = INT64_MAX / 2;

  int64_t before_ns_ = 0;
  int64_t ahead_ns_ = kFarAhead_ns;  ///< how far ahead the film is always known
  int64_t late_ns_ = 0;
};

/// The wrenches of frames and samples of a track by running time, which the streaming thread pushes
/// and the loop finds. Each entry carries the generation in which it was pushed, and cancel()
/// begins another:
///
/// - A ring holds entries in the order of their generations, because one thread pushes.
/// - The timeline and the track hold entries of timeline_generation_ only.
/// - find() drops entries of earlier generations. It leaves those of a later one in the ring: they
///   were pushed after a cancel() that followed its check of the generation, and are for the next
///   tick.
class LoopSchedule {
 public:
  /// A wrench enters the timeline this long before the previous one is due, so that the slope there
  /// is known at any frame rate. Later wrenches wait in the ring, so that a long queue of frames
  /// before the screen does not displace the due wrench.
  static constexpr int64_t kHorizon_ns = 100'000'000;

  // --- streaming thread

  /// Returns false when the ring is full because the loop does not run, does not play, or is far
  /// behind.
  bool push(const TimedWrench& entry) noexcept {
    return wrenches_.push({generation_.load(std::memory_order_acquire), entry});
  }
  bool push(const TrackBlock& block) noexcept {
    return blocks_.push({generation_.load(std::memory_order_acquire), block});
  }

  // --- any thread

  /// Discards everything that was pushed before this call.
  void cancel() noexcept { generation_.fetch_add(1, std::memory_order_acq_rel); }

  /// The time from when each frame was due on the screen until its wrench was reached.
  const LatencyHistogram& skew() const noexcept { return skew_; }

  // --- loop thread

  /// Returns the wrench to send now to a device that renders it `lag_ns` later; nothing unless
  /// playing. Samples of a track take precedence over frames.
  TimelineResult find(bool playing, int64_t running_ns, int64_t lag_ns = 0) noexcept;

  /// How much later than its frame the device renders the last found wrench.
  int64_t late_ns() const noexcept { return look_ahead_.late_ns(); }
  /// How much later than its motion the wrench of the last reached frame came, because the frame
  /// became known too late.
  int64_t motion_late_ns() const noexcept { return motion_late_ns_; }

  /// The number of wrenches since the last call whose time was not later than the previous one's.
  uint64_t take_refused() noexcept;

 private:
  template <typename Entry>
  struct Scheduled {
    uint32_t generation = 0;
    Entry entry;
  };

  void clear(uint32_t generation) noexcept;
  bool is_of_the_future(uint32_t generation) const noexcept;
  int64_t time_to_ask_for(int64_t running_ns, int64_t lag_ns) noexcept;
  void take_wrenches(bool playing, int64_t running_ns) noexcept;
  TimelineResult read_track(bool playing, int64_t running_ns) noexcept;

  // Shared between threads.
  SpscRing<Scheduled<TimedWrench>, 256> wrenches_;
  SpscRing<Scheduled<TrackBlock>, 64> blocks_;
  std::atomic<uint32_t> generation_{0};
  LatencyHistogram skew_;
  // Loop thread only.
  WrenchTimeline timeline_;
  TrackReader track_;
  uint32_t timeline_generation_ = 0;
  LookAhead look_ahead_;
  int64_t known_ns_ = INT64_MIN;   ///< time until which frames or samples are known
  int64_t newest_ns_ = INT64_MIN;  ///< running time of the newest wrench in the timeline
  int64_t before_newest_ns_ = INT64_MIN;
  int64_t reached_ns_ = INT64_MIN;  ///< running time of the last reached frame
  int64_t motion_late_ns_ = 0;
  uint64_t refused_ = 0;
};

}  // namespace spidar
