// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include <Eigen/Core>

#include "spidar/chain/grip_brake.h"
#include "spidar/grip/grip.h"
#include "spidar/limits/force_limits.h"
#include "spidar/limits/vibration_budget.h"
#include "spidar/limits/wrench_limits.h"
#include "spidar/loop/loop_schedule.h"
#include "spidar/loop/loop_time.h"
#include "spidar/loop/missing_answers.h"
#include "spidar/loop/tick_record.h"
#include "spidar/loop/wrench_callback.h"
#include "spidar/realtime/seqlock.h"
#include "spidar/realtime/spsc_ring.h"
#include "spidar/touch/touch_rendering.h"

namespace spidar {

class IdleWatch {
 public:
  /// The time without a force or a movement after which the device is idle.
  static constexpr double kAfter_s = 300;
  /// If the grip has moved further than this, somebody holds it.
  static constexpr double kMove_m = 5e-3;

  /// Call this in each tick, `dt_s` after the last one. `wanted` says that a force is wanted.
  /// Returns true once there has been neither a force nor a movement for kAfter_s, and false again
  /// as soon as there is either.
  bool idle(bool wanted, const Eigen::Vector3d& position_m, double dt_s) noexcept {
    if (wanted || (position_m - from_m_).norm() > kMove_m) {
      from_m_ = position_m;
      rested_s_ = 0;
    }
    rested_s_ += dt_s;
    return rested_s_ > kAfter_s;
  }

  void reset() noexcept { rested_s_ = 0; }

 private:
  Eigen::Vector3d from_m_ = Eigen::Vector3d::Zero();
  double rested_s_ = 0;
};

/// The 1 ms cycle, time → wrench → limits → grip → pose, without its thread: the owner calls
/// tick(). The object is large (about 2 MB), so do not put it on the stack.
class HapticLoop {
 public:
  /// The time in which tensions rise from zero to rest after the device is opened.
  static constexpr double kEnergise_s = 0.2;
  /// The time in which tensions fall to zero before the device is closed.
  static constexpr double kRelease_s = 0.05;
  /// The number of failed exchanges in a row after which a device is lost.
  static constexpr int kMaxErrors = MissingAnswers::kMax;
  /// The longest time step for a rising force, however late a tick is, so that a stall does not end
  /// in a jump of the force. Falling values use the time that has really passed.
  static constexpr int64_t kMaxStep_ns = 2 * kTick_ns;
  static constexpr size_t kForces = 1024, kRecords = 4096;  ///< capacities in ticks

  /// Does not open `grip`; open() does.
  explicit HapticLoop(std::unique_ptr<Grip> grip, const SafetyLimits& limits = {});
  ~HapticLoop();
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  // --- streaming thread

  /// Schedules a wrench for the running time `entry.time_ns` on the screen. Returns false when the
  /// ring is full because the loop does not run, does not play, or is far behind.
  bool schedule(const TimedWrench& entry) noexcept { return schedule_.push(entry); }
  /// Schedules samples of a track, in the order of their times. Samples override frames.
  bool schedule(const TrackBlock& block) noexcept { return schedule_.push(block); }

  // --- any thread

  /// Lets the grip touch the surfaces that are published in `touch`, which must outlive the loop.
  /// The contact force is added to the wanted wrench, before every safety step. Null, the default:
  /// there is nothing to touch.
  void connect_touch(touch::Mailbox* touch) noexcept {
    touch_mailbox_.store(touch, std::memory_order_release);
  }

  /// The loop calls this in every tick in which the pose is known, and adds its wrench to the
  /// wanted one before every safety step.
  WrenchCallback& callback() noexcept { return callback_; }
  const WrenchCallback& callback() const noexcept { return callback_; }

  /// Discards everything that was scheduled before this call (flush).
  void cancel_scheduled() noexcept { schedule_.cancel(); }

  void set_playback_clock(const PlaybackClock& clock) noexcept { shared_clock_.store(clock); }
  /// One caller at a time. From the next tick on, the force approaches a new total limit at the
  /// slew limit. A grip that can fly gets at most GripTraits::most_force_N().
  void set_limits(const SafetyLimits& limits) noexcept { limits_.set(limits); }

  LoopSnapshot snapshot() const noexcept { return snapshot_.load(); }

  /// The time from when each frame was due on the screen until its wrench was reached.
  const LatencyHistogram& skew() const noexcept { return schedule_.skew(); }

  /// Removes the oldest unread tick, for one reader. New ticks are dropped while the ring is full.
  bool pop_record(TickRecord& record) noexcept { return records_.pop(record); }
  /// Removes the forces of the oldest tick and stores them in `tick`. For another reader. New
  /// forces are dropped while those of kForces ticks are unread.
  bool pop_force(ForceTick& tick) noexcept { return forces_.pop(tick); }

  /// Why a lost device cannot be opened again although something is there, such as another device
  /// under its name. Empty while nothing is there, and until a reason has occurred twice in a row,
  /// because the first may pass: udev needs a moment to permit a new device.
  std::string refusal() const;

  const Grip& grip() const noexcept { return *grip_; }

  /// From the next tick on, everything that pulls ramps to zero; see released().
  void begin_close() noexcept { closing_.store(true, std::memory_order_release); }

  // --- loop thread, or while there is none

  /// The vibration budget of the hand, which one loop takes over from another.
  VibrationBudget& vibration() noexcept { return vibration_; }

  /// Opens the grip. The following ticks energise it. Throws DeviceError.
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

  /// Closes the device at once, which sets the motors to zero without a ramp.
  void close() noexcept;

 private:
  /// The time of a tick, since the last one that the device has answered.
  struct Step {
    double rises_s = 0;  ///< at most kMaxStep_ns
    double falls_s = 0;
  };
  /// The time constant of the mean lateness of answers, which lowers the force limit: a released
  /// grip is stopped within it, and one late answer in a hundred hardly counts.
  static constexpr double kLateness_s = 0.1;

  void energise() noexcept;
  void lose() noexcept;
  void refuse(const std::string& reason);
  void find_wanted(TickRecord& record) noexcept;
  void count_gap(const TickRecord& record) noexcept;
  void touch(TickRecord& record, int64_t passed_ns) noexcept;
  void run_callback(TickRecord& record, int64_t passed_ns) noexcept;
  bool is_fresh(const TickRecord& record) const noexcept;
  SafetyLimits braking_limits() const noexcept;
  void command(TickRecord& record, const Step& step, int64_t passed_ns) noexcept;
  void limit(TickRecord& record, const Step& step, double passed_s) noexcept;
  void exchange(TickRecord& record, const Step& step) noexcept;
  void count_energy(const TickRecord& record) noexcept;
  void follow(double passed_s) noexcept;
  void undo(TickRecord& record) noexcept;
  void publish(const TickRecord& record) noexcept;

  const std::unique_ptr<Grip> grip_;
  // Shared between threads.
  LoopSchedule schedule_;
  SpscRing<TickRecord, kRecords> records_;
  SpscRing<ForceTick, kForces> forces_;
  std::atomic<bool> closing_{false};
  std::atomic<touch::Mailbox*> touch_mailbox_{nullptr};
  WrenchCallback callback_;
  Seqlock<PlaybackClock> shared_clock_;
  ForceLimits limits_;
  Seqlock<LoopSnapshot> snapshot_;
  Seqlock<std::array<char, 512>> refusal_{std::array<char, 512>{}};  ///< zero-terminated
  // Loop thread only.
  PlaybackClock clock_;
  Wrench exerted_;     ///< delivered by the last acknowledged command
  Wrench above_rest_;  ///< without the strings at rest and the commanded torque
  Pose at_;            ///< pose after the last exchange
  touch::Rendering touch_;
  WrenchLimits safety_;
  Wrench acknowledged_;  ///< commanded in the last tick that the device has answered
  GripBrake brake_{grip_->traits().body, grip_->traits().drive_lag_s};
  VibrationBudget vibration_{grip_->traits().radius_m};
  IdleWatch idle_;
  DeviceState state_ = DeviceState::kClosed;
  double power_ = 0;               ///< GripCommand::power
  double acknowledged_power_ = 0;  ///< power of the last acknowledged command
  MissingAnswers missing_;
  int64_t unanswered_ns_ = 0;  ///< time since the last answered tick
  double late_s_ = 0;          ///< mean time between two answers beyond a tick
  uint64_t gap_ticks_ = 0;     ///< ticks since the newest frame expired
  int64_t untrusted_ns_ = 0;   ///< time for which the pose has not been trusted
  int64_t unfelt_ns_ = 0;      ///< time for which no command was strong enough to be felt
  bool ticked_ = false;
  int64_t last_now_ns_ = 0;
  int64_t last_deadline_ns_ = 0;
  LoopCounters counters_;
  std::string newest_refusal_;  ///< reason of the latest reopen()
};

}  // namespace spidar
