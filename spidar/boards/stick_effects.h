// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The effects of a force-feedback device, set by a thread that may wait for the driver.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Core>

#include "spidar/device.h"
#include "spidar/guardian/guardian.h"
#include "spidar/protocols/force_feedback.h"
#include "spidar/realtime/seqlock.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// A driver that needs 50 ms for an update gives a position every 55 ms, and a hand moves a stick
/// by 20 mm in that time. As a step, this would look to a damper like a very fast hand. The
/// position therefore moves to a new reading at a constant speed within the time that the last
/// update took. This costs no delay: a level is set in the same update that brings the next
/// reading, when the position has just arrived.
///
/// see() is called by the thread that makes the updates, everything else by the one that exchanges.
class StickPosition {
 public:
  /// The slowest that a position moves to a new reading.
  static constexpr int64_t kLongest_ns = 100'000'000;

  /// Before see() is called for the first time.
  void start(const ff::Position& position, int64_t now_ns) noexcept {
    seen_ns_ = shown_ns_ = now_ns;
    aim_ = {position, now_ns};
    newest_.store(aim_);
    shown_ = fraction_of(position);
  }

  void see(const ff::Position& position, int64_t now_ns) noexcept {
    newest_.store({position, now_ns + std::min(now_ns - seen_ns_, kLongest_ns)});
    seen_ns_ = now_ns;
  }

  /// Moves to where the position is at this time.
  void advance(int64_t now_ns) noexcept {
    newest_.try_load(aim_);  // keeps the previous one while a new one is being written
    const Eigen::Vector2d to = fraction_of(aim_.position);
    const auto passed_ns = static_cast<double>(now_ns - shown_ns_);
    const auto left_ns = static_cast<double>(aim_.arrival_ns - shown_ns_);
    shown_ =
        passed_ns >= left_ns ? to : Eigen::Vector2d(shown_ + passed_ns / left_ns * (to - shown_));
    shown_ns_ = now_ns;
  }

  /// Right and up, −1 … 1, as of the last advance().
  const Eigen::Vector2d& fraction() const noexcept { return shown_; }
  /// See ff::Position, as of the last advance().
  uint32_t buttons() const noexcept { return aim_.position.buttons; }

 private:
  struct Aim {
    ff::Position position;
    int64_t arrival_ns = 0;
  };

  static Eigen::Vector2d fraction_of(const ff::Position& position) noexcept {
    return Eigen::Vector2d(position.right, position.up) / ff::Position::kFull;
  }

  int64_t seen_ns_ = 0;
  Seqlock<Aim> newest_;
  Aim aim_;
  Eigen::Vector2d shown_ = Eigen::Vector2d::Zero();
  int64_t shown_ns_ = 0;
};

/// Exchanges are faster than updates. A failed update is reported to one exchange only, because the
/// haptic loop gives a device up after 20 faults in a row, which would be a single one of a slow
/// driver. Every exchange gets a fault when nothing shows that the device still follows: kFailures
/// updates have failed in a row, or none has ended for kPatience_ns, because the driver does not
/// return. The device holds its last force meanwhile, so the loop must not take it for a healthy
/// one.
///
/// finish() is called by the thread that makes the updates, everything else by the one that
/// exchanges.
class UpdateWatch {
 public:
  /// Failures in a row before all exchanges fail, as for a board on USB (see StringLink): one
  /// fault may concern only one packet.
  static constexpr uint32_t kFailures = 3;
  /// Twice the time that the slowest drivers need, about 50 ms, and as long as other exchanges of a
  /// force-feedback device may last.
  static constexpr int64_t kPatience_ns = 100'000'000;

  /// Before finish() is called for the first time.
  void start(int64_t now_ns) noexcept {
    updates_ = last_ = {LinkFault::kNone, 0, 0, now_ns};
    newest_.store(updates_);
    reported_ = 0;
  }

  void finish(LinkFault fault, int64_t now_ns) noexcept {
    updates_.finished_ns = now_ns;
    ++updates_.in_a_row;
    if (fault == LinkFault::kNone) {
      updates_.in_a_row = 0;
    } else {
      updates_.fault = fault;
      ++updates_.failed;
    }
    newest_.store(updates_);
  }

  /// For one exchange.
  LinkFault report(int64_t now_ns) noexcept {
    newest_.try_load(last_);  // keeps the previous one while a new one is being written
    const bool is_new = last_.failed != reported_;
    reported_ = last_.failed;
    if (now_ns - last_.finished_ns > kPatience_ns) return LinkFault::kTimeout;
    return is_new || last_.in_a_row >= kFailures ? last_.fault : LinkFault::kNone;
  }

 private:
  struct Updates {
    LinkFault fault = LinkFault::kNone;  ///< of the last one that failed
    uint32_t failed = 0;
    uint32_t in_a_row = 0;  ///< failed since the last one that succeeded
    int64_t finished_ns = 0;
  };

  Updates updates_;
  Seqlock<Updates> newest_;
  Updates last_;
  uint32_t reported_ = 0;
};

/// Drivers may need a long time for an update, or lose updates that come too fast. One effect for
/// each axis is set at most every kUpdate_ms, one at a time, and only if it has changed. It lasts
/// ff::kEffect_ms, and is started again every kRefresh_ms as long as forces arrive, so that it ends
/// by itself when this process hangs or is stopped.
///
/// A call of a driver that hangs cannot be ended: the kernel lets no other call to the device pass
/// until it returns, not even the guardian's. report() then returns a timeout, see UpdateWatch,
/// and close() leaves the thread alone, which shares the ownership of this object and releases the
/// device when the driver returns.
///
/// A device that is only opened and read keeps its gain and its autocentre.
class StickEffects : public std::enable_shared_from_this<StickEffects> {
 public:
  static constexpr int kUpdate_ms = 5;
  static constexpr int kRefresh_ms = 50;
  /// How long close() waits for a driver that hangs, beyond the time that the centring spring
  /// needs.
  static constexpr int kHang_ms = 300;

  struct Options {
    /// The fraction of the device's strength that is used, at most 1; 0: kDefaultGain, or all of a
    /// device that only rumbles.
    double gain = 0;
    /// The driver turns the force to the other side: right and up.
    std::array<bool, 2> flipped{};
  };

  enum class Updates {
    kOwnThread,  ///< cycle() never waits for the driver
    kInCycle,    ///< every kUpdate_ms-th cycle(), for emulations
  };

  /// Linux does not report how strong a device is. A wheel may turn with 20 N m, so a fifth is used
  /// of a device that has a directional force, unless somebody has asked for more.
  static constexpr double kDefaultGain = 0.2;

  StickEffects(std::string name, std::unique_ptr<Transport> transport, Updates updates,
               const Options& options);

  /// Throws DeviceError.
  void open();
  /// The centring spring stays off if `reopening`, for a hand that still holds the stick; the next
  /// closing returns it, also if the device is not opened any more.
  void close(bool reopening) noexcept;
  /// Sets the force in newtons, right and up, and whether forces are switched on. Returns what the
  /// exchange is to report. Does not wait.
  LinkFault cycle(const Eigen::Vector2d& force_N, bool pulls) noexcept;
  /// Position of the stick, −1 … 1, as of the last cycle().
  const Eigen::Vector2d& position() const noexcept { return position_.fraction(); }
  uint32_t buttons() const noexcept { return position_.buttons(); }

  std::vector<LastWill> last_wills() const;
  /// What the open device can do.
  const ff::Description& description() const noexcept { return description_; }
  size_t effects() const noexcept { return effect_count_; }
  double gain() const noexcept {
    return options_.gain > 0 ? options_.gain : description_.constant ? kDefaultGain : 1;
  }

 private:
  struct Effect {
    int16_t number = ff::kNewEffect;
    int level = 0;       ///< that is set; for a rumble effect its strength
    bool known = false;  ///< the level is known to be set
    int64_t played_ns = 0;
  };

  void begin_effects();
  void start_updates();
  Transfer upload(size_t effect, int level) noexcept;
  Transfer play(size_t effect) noexcept;
  Transfer send(ByteView event) noexcept;
  /// Once forces are switched on: sets gain to the fraction that is used and autocentre to off,
  /// which earlier programs or the driver may have left otherwise, and which would scale the force
  /// or add to it. Until both have been accepted, no level is set.
  LinkFault take_settings() noexcept;
  /// What makes the settings what they were: gain to full and, if the driver had turned it on,
  /// autocentre by a ramp. Events that are kUpdate_ms apart.
  std::vector<ff::EventBytes> former_settings() const;
  void return_settings() noexcept;
  /// Those of a device that was closed to be reopened, and was not.
  void return_settings_later() noexcept;
  bool thread_runs() const;
  int wanted_level(size_t effect) const noexcept;
  /// Reads the position, sets one level, starts effects again, and notes how it ended.
  void update() noexcept;
  LinkFault read_and_set() noexcept;
  LinkFault set_one_level() noexcept;
  LinkFault refresh() noexcept;
  void end_effects() noexcept;
  /// The time; in emulations that of the cycles, which need not take a millisecond.
  int64_t now_ns() const noexcept;
  void run() noexcept;

  const std::string name_;
  const std::unique_ptr<Transport> transport_;
  const Updates updates_;
  const Options options_;

  ff::Description description_;
  std::array<Effect, 2> effects_{};  ///< right and up; a rumble effect uses the first
  size_t effect_count_ = 0;
  size_t turn_ = 0;  ///< the effect that is checked first
  int64_t cycle_ = 0;
  std::thread thread_;
  std::future<void> ended_;  ///< of the thread; not valid before there is one
  std::atomic<bool> stop_{false};
  std::atomic<bool> reopening_{false};
  std::atomic<bool> pulled_{false};    ///< since it was opened
  std::atomic<int64_t> cycled_ns_{0};  ///< the latest cycle()
  bool has_settings_ = false;          ///< take_settings() has succeeded
  bool settings_changed_ = false;  ///< and not returned; since then, other openings may have been
  std::vector<ff::EventBytes> former_settings_;  ///< of the open device
  UpdateWatch updated_;
  std::array<std::atomic<double>, 2> force_N_{};
  StickPosition position_;
};

}  // namespace spidar
