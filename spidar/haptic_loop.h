/// What happens once a millisecond: time → wrench → safety → tensions → device → pose.
#pragma once

#include <atomic>
#include <cstdint>

#include "core/api.h"
#include "core/pose.h"
#include "core/pose_solver.h"
#include "core/string_geometry.h"
#include "core/tension_solver.h"
#include "core/wrench_timeline.h"
#include "spidar/device.h"
#include "spidar/playback_clock.h"
#include "spidar/profile.h"
#include "spidar/safety.h"
#include "spidar/seqlock.h"
#include "spidar/spsc_ring.h"

namespace spidar {

constexpr int64_t kTick_ns = 1'000'000;  ///< 1 kHz

enum class DeviceState {
  kClosed,
  kOpening,  ///< tensions ramp up to rest
  kRunning,
  kLost,     ///< does not answer; tried again
};

/// One tick, as it was. Also the row of the haptic trace.
struct TickRecord {
  uint64_t tick = 0;
  int64_t monotonic_ns = 0;   ///< when the device was served
  int64_t lateness_ns = 0;    ///< behind the deadline
  int64_t running_ns = 0;     ///< running time on the screen
  int64_t frame_ns = 0;       ///< running time of the frame whose wrench was reached last
  Found found = Found::kNothing;
  Wrench wanted;              ///< from the timeline
  Wrench commanded;           ///< after finite, limit, slew and stale
  Wrench delivered;           ///< W · tension, what the strings can do of it
  StringVector tension_N = StringVector::Zero();
  Pose pose;
  double pose_residual_m = 0;
  DeviceState device = DeviceState::kClosed;
  bool playing = false;
};

/// Numbers since the loop was opened.
struct LoopCounters {
  uint64_t ticks = 0;
  uint64_t overruns = 0;         ///< ticks that began more than one period late
  uint64_t exchange_errors = 0;
  uint64_t pose_errors = 0;
  uint64_t rejected_wrenches = 0;  ///< not finite
  uint64_t times_lost = 0;
};

struct LoopSnapshot {
  TickRecord last;
  LoopCounters counters;
};

/// The loop without its thread: whoever owns it calls tick(). Of the other members schedule() belongs
/// to one thread (streaming), the rest may be called from any.
class SPIDAR_API HapticLoop {
 public:
  /// `device` outlives the loop and is opened by open(). Throws std::invalid_argument when the
  /// profile has fewer than six strings.
  HapticLoop(const Profile& profile, Device& device, const SafetyLimits& limits = {});

  // --- streaming thread

  /// False when the ring is full: the loop does not run or is far behind.
  bool schedule(const TimedWrench& entry) noexcept;

  // --- any thread

  /// Everything scheduled before this call is forgotten (flush).
  void cancel_scheduled() noexcept { generation_.fetch_add(1, std::memory_order_acq_rel); }

  /// One caller at a time.
  void set_playback_clock(const PlaybackClock& clock) noexcept { clock_.store(clock); }
  void set_limits(const SafetyLimits& limits) noexcept { limits_.store(limits); }

  LoopSnapshot snapshot() const noexcept { return snapshot_.load(); }

  /// Every tick in order, for one reader; ticks are dropped when nobody reads.
  bool pop_record(TickRecord& record) noexcept { return records_.pop(record); }

  // --- loop thread

  /// Opens the device; its strings are energised by the ticks that follow. Throws DeviceError.
  void open();

  /// One cycle at `now_ns` for the deadline given (both CLOCK_MONOTONIC). Neither allocates, locks,
  /// logs nor throws. After kLost it only counts; call reopen().
  void tick(int64_t deadline_ns, int64_t now_ns) noexcept;

  /// Tries to get a lost device back. May block and allocate: nothing is energised at that time.
  bool reopen() noexcept;

  bool lost() const noexcept { return state_ == DeviceState::kLost; }

  /// Ramps down in `steps` ticks without waiting between them when `sleep` is null, then closes.
  void close(void (*sleep)(int64_t ns)) noexcept;

 private:
  struct Scheduled {
    uint32_t generation = 0;
    TimedWrench entry;
  };

  const Profile profile_;
  Device& device_;
  // Shared.
  SpscRing<Scheduled, 256> scheduled_;
  SpscRing<TickRecord, 4096> records_;
  std::atomic<uint32_t> generation_{0};
  Seqlock<PlaybackClock> clock_;
  Seqlock<SafetyLimits> limits_;
  Seqlock<LoopSnapshot> snapshot_;
  // Loop thread only.
  WrenchTimeline timeline_;
  uint32_t timeline_generation_ = 0;
  FiniteCheck finite_;
  SlewLimit slew_;
  StaleRamp stale_;
  PoseSolver pose_solver_;
  TensionSolver tension_solver_;
  DeviceState state_ = DeviceState::kClosed;
};

}  // namespace spidar
