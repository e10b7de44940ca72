// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the fast exchanges know about a device with slow updates: the position, and whether the
/// device still responds.
#pragma once

#include <algorithm>
#include <cstdint>

#include <Eigen/Core>

#include "spidar/device.h"
#include "spidar/devices/force_feedback/packets.h"
#include "spidar/realtime/seqlock.h"

namespace spidar::boards {

/// Interpolates the position of a stick. A driver that needs 50 ms for an update gives a position
/// every 55 ms, while a hand moves a stick by 20 mm: to a damper, the step of a very fast hand. The
/// position therefore moves to a new reading at a constant speed, for as long as the last update
/// took. This does not delay the force: the update that sets a level also brings the next reading,
/// just when the position has arrived.
///
/// The thread of the updates calls update(); the thread of the exchanges calls everything else.
class StickPosition {
 public:
  /// The longest time in which the position moves to a new reading.
  static constexpr int64_t kLongest_ns = 100'000'000;

  /// Call this before the first update().
  void start(const ff::Position& position, int64_t now_ns) noexcept {
    seen_ns_ = shown_ns_ = now_ns;
    aim_ = {position, now_ns};
    newest_.store(aim_);
    shown_ = fraction_of(position);
  }

  void update(const ff::Position& position, int64_t now_ns) noexcept {
    newest_.store({position, now_ns + std::min(now_ns - seen_ns_, kLongest_ns)});
    seen_ns_ = now_ns;
  }

  /// Moves the position on to `now_ns`.
  void advance(int64_t now_ns) noexcept {
    newest_.try_load(aim_);  // keeps the previous reading while a new one is being written
    const Eigen::Vector2d to = fraction_of(aim_.position);
    const auto passed_ns = static_cast<double>(now_ns - shown_ns_);
    const auto left_ns = static_cast<double>(aim_.arrival_ns - shown_ns_);
    shown_ =
        passed_ns >= left_ns ? to : Eigen::Vector2d(shown_ + passed_ns / left_ns * (to - shown_));
    shown_ns_ = now_ns;
  }

  /// Returns right and up, −1 … 1, as of the last advance().
  const Eigen::Vector2d& fraction() const noexcept { return shown_; }
  /// Returns ff::Position::buttons as of the last advance().
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

/// Converts the results of updates to faults of exchanges. Exchanges are faster than updates. If
/// every exchange during a failed update of a slow driver reported the fault, there could be 20
/// faults in a row, after which the haptic loop gives the device up; so only one exchange does. But
/// when kFailures updates have failed in a row, or none has ended for kTimeout_ns because the
/// driver does not return, every exchange reports a fault: the device holds its last force
/// meanwhile, and must not seem healthy.
///
/// The thread of the updates calls finish(); the thread of the exchanges calls everything else.
class UpdateWatch {
 public:
  /// Failures in a row after which all exchanges fail, as for a board on USB (see StringLink): a
  /// single fault may concern only one packet.
  static constexpr uint32_t kFailures = 3;
  /// Twice the time that the slowest drivers need, about 50 ms, and as long as other exchanges of a
  /// force-feedback device may last.
  static constexpr int64_t kTimeout_ns = 100'000'000;

  /// Call this before the first finish().
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

  /// Returns the result of one exchange.
  LinkFault report(int64_t now_ns) noexcept {
    newest_.try_load(last_);  // keeps the previous result while a new one is being written
    const bool is_new = last_.failed != reported_;
    reported_ = last_.failed;
    if (now_ns - last_.finished_ns > kTimeout_ns) return LinkFault::kTimeout;
    return is_new || last_.in_a_row >= kFailures ? last_.fault : LinkFault::kNone;
  }

 private:
  struct Updates {
    LinkFault fault = LinkFault::kNone;  ///< fault of the last update that failed
    uint32_t failed = 0;
    uint32_t in_a_row = 0;  ///< failed updates since the last success
    int64_t finished_ns = 0;
  };

  Updates updates_;
  Seqlock<Updates> newest_;
  Updates last_;
  uint32_t reported_ = 0;
};

}  // namespace spidar::boards
