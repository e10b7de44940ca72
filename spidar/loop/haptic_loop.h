// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The 1 ms cycle: time → wrench → safety → tensions → device → pose.
#pragma once

#include <atomic>
#include <cstdint>

#include "core/force/wrench_timeline.h"
#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"
#include "core/track/track_reader.h"
#include "spidar/device.h"
#include "spidar/loop/grip_brake.h"
#include "spidar/loop/grip_motion.h"
#include "spidar/loop/grip_watch.h"
#include "spidar/loop/idle_watch.h"
#include "spidar/loop/motor_heat.h"
#include "spidar/loop/playback_clock.h"
#include "spidar/loop/safety.h"
#include "spidar/loop/tension_command.h"
#include "spidar/loop/tick_record.h"
#include "spidar/loop/vibration_budget.h"
#include "spidar/profiles/profile.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/realtime/seqlock.h"
#include "spidar/realtime/spsc_ring.h"
#include "spidar/touch/touch_mailbox.h"
#include "spidar/touch/touch_rendering.h"

namespace spidar {

constexpr int64_t kTick_ns = 1'000'000;  ///< 1 kHz

/// The loop without its thread: the owner calls tick(). The object is large (about 2 MB), so do not
/// put it on the stack.
class HapticLoop {
 public:
  /// Time in which tensions rise from zero to rest after the device is opened.
  static constexpr double kEnergise_s = 0.2;
  /// Time in which they fall to zero before it is closed.
  static constexpr double kRelease_s = 0.05;
  /// Number of failed exchanges in a row after which a device is lost.
  static constexpr int kMaxErrors = 20;
  /// Upper bound of the time that one tick counts for, however late it is, so that a stall does not
  /// end in a step.
  static constexpr int64_t kMaxStep_ns = 2 * kTick_ns;
  /// A wrench enters the timeline this long before the previous one is due, so that the slope there
  /// is known at any frame rate. Later wrenches wait in the ring, so that a long queue of frames
  /// before the screen does not displace the wrench that is due.
  static constexpr int64_t kHorizon_ns = 100'000'000;

  /// `device` outlives the loop and is opened by open(). Throws std::invalid_argument when the
  /// profile has fewer than six strings.
  HapticLoop(const Profile& profile, Device& device, const SafetyLimits& limits = {});
  /// Closes the device if that has not been done.
  ~HapticLoop();
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  // --- streaming thread

  /// Schedules a wrench for the running time `entry.time_ns` on the screen. Returns false when the
  /// ring is full because the loop does not run, does not play, or is far behind.
  bool schedule(const TimedWrench& entry) noexcept;
  /// The same for samples of a track, in the order of their times. Where there are samples, they
  /// are rendered instead of frames.
  bool schedule(const TrackBlock& block) noexcept;

  // --- any thread

  /// Lets the grip touch the surfaces that are published in `touch`, which must outlive the loop.
  /// The contact force is added to the wanted wrench, before every safety step. Null, the default:
  /// there is nothing to touch.
  void connect_touch(TouchMailbox* touch) noexcept {
    touch_mailbox_.store(touch, std::memory_order_release);
  }

  /// Discards everything that was scheduled before this call (flush).
  void cancel_scheduled() noexcept { generation_.fetch_add(1, std::memory_order_acq_rel); }

  /// One caller at a time.
  void set_playback_clock(const PlaybackClock& clock) noexcept { shared_clock_.store(clock); }
  /// One caller at a time. A lower total limit takes effect in the next tick; a higher one is
  /// reached through the slew limit.
  void set_limits(const SafetyLimits& limits) noexcept { shared_limits_.store(limits); }

  LoopSnapshot snapshot() const noexcept { return snapshot_.load(); }

  /// Time from when each frame was due on the screen until its wrench was reached.
  const LatencyHistogram& skew() const noexcept { return skew_; }

  /// Returns every tick in order, for one reader. Ticks are dropped if they are not read.
  bool pop_record(TickRecord& record) noexcept { return records_.pop(record); }

  /// From the next tick on, wrench and tensions ramp to zero; see released().
  void begin_close() noexcept { closing_.store(true, std::memory_order_release); }

  // --- loop thread, or while there is none

  /// What is left for this hand, to be taken over from and by other loops.
  VibrationBudget& vibration() noexcept { return vibration_; }

  /// Opens the device. The following ticks energise its strings. Throws DeviceError.
  void open();

  /// Runs one cycle at `now_ns` for the given deadline (both CLOCK_MONOTONIC). Neither allocates,
  /// locks, logs nor throws. In kLost it only counts ticks; call reopen().
  void tick(int64_t deadline_ns, int64_t now_ns) noexcept;

  bool lost() const noexcept { return state_ == DeviceState::kLost; }

  /// Tries to reopen a lost device; returns false if that fails. May block and allocate, because
  /// nothing is energised at that time. Its duration does not count as missed deadlines.
  bool reopen() noexcept;

  /// After begin_close(): true once the ticks have ramped the motors to zero, or if the device is
  /// lost or closed.
  bool released() const noexcept;

  /// Closes the device at once, which sets the motors to zero without a ramp if they are not at
  /// zero.
  void close() noexcept;

 private:
  template <typename Entry>
  struct Scheduled {
    uint32_t generation = 0;
    Entry entry;
  };

  void energise() noexcept;
  void lose() noexcept;
  void forget_timeline(uint32_t generation) noexcept;
  bool is_of_the_future(uint32_t generation) const noexcept;
  void take_scheduled(bool playing, int64_t running_ns) noexcept;
  TimelineResult read_track(bool playing, int64_t running_ns) noexcept;
  void find_wanted(TickRecord& record) noexcept;
  void touch(TickRecord& record, int64_t passed_ns) noexcept;
  void command(TickRecord& record, double dt_s) noexcept;
  void pull(TickRecord& record, double dt_s) noexcept;
  void exchange(TickRecord& record, double dt_s) noexcept;
  void follow(bool encoders, const Wrench& strings, double dt_s) noexcept;
  void undo(TickRecord& record) noexcept;
  void publish(const TickRecord& record) noexcept;

  const Profile profile_;
  Device& device_;
  // Shared.
  SpscRing<Scheduled<TimedWrench>, 256> scheduled_;
  SpscRing<Scheduled<TrackBlock>, 64> scheduled_blocks_;
  SpscRing<TickRecord, 4096> records_;
  std::atomic<uint32_t> generation_{0};
  std::atomic<bool> closing_{false};
  std::atomic<TouchMailbox*> touch_mailbox_{nullptr};
  Seqlock<PlaybackClock> shared_clock_;
  Seqlock<SafetyLimits> shared_limits_;
  Seqlock<LoopSnapshot> snapshot_;
  LatencyHistogram skew_;
  // Loop thread only.
  PlaybackClock clock_;
  SafetyLimits limits_;
  WrenchTimeline timeline_;
  TrackReader track_;
  uint32_t timeline_generation_ = 0;
  int64_t newest_ns_ = INT64_MIN;  // running time of the newest wrench in the timeline
  int64_t before_newest_ns_ = INT64_MIN;
  int64_t reached_ns_ = INT64_MIN;  // running time of the frame reached last
  TouchRendering touch_;
  WrenchSafety safety_;
  GripWatch grip_;
  GripMotion motion_;
  GripBrake brake_;
  TensionCommand tension_command_;
  TensionSlew tension_slew_;
  MotorHeat heat_;
  VibrationBudget vibration_{profile_.geometry.grip_radius_m()};
  IdleWatch idle_;
  DeviceState state_ = DeviceState::kClosed;
  double energised_ = 0;  // share of the tensions that is output
  // The last acknowledged command, from which the next tick continues.
  StringVector acknowledged_N_ = StringVector::Zero();
  double acknowledged_energised_ = 0;
  int errors_in_a_row_ = 0;
  int64_t untrusted_ns_ = 0;  // time for which the pose has not been trusted
  int64_t unfelt_ns_ = 0;     // time for which no force has been requested
  bool ticked_ = false;
  int64_t last_now_ns_ = 0;
  int64_t last_deadline_ns_ = 0;
  LoopCounters counters_;
};

}  // namespace spidar
