// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The position of a stick between two updates of its driver.
#pragma once

#include <algorithm>
#include <cstdint>

#include <Eigen/Core>

#include "spidar/protocols/force_feedback.h"
#include "spidar/realtime/seqlock.h"

namespace spidar {

/// A driver that needs 50 ms for an update gives a position every 55 ms, and a hand moves a stick
/// by 20 mm in that time. As a step, this would look to a damper like a very fast hand. The
/// position therefore moves to a new reading at a constant speed within the time that the last
/// update took. This costs no delay: a level is set in the same update that brings the next
/// reading, when the position has just arrived.
///
/// see() is called by the thread that makes the updates, everything else by the one that exchanges.
class StickPlace {
 public:
  /// The slowest that a position moves to a new reading.
  static constexpr int64_t kLongest_ns = 100'000'000;

  /// Before see() is called for the first time.
  void start(const ff::Position& position, int64_t now_ns) noexcept {
    seen_ns_ = shown_ns_ = now_ns;
    aim_ = {position, now_ns};
    newest_.store(aim_);
    shown_ = share_of(position);
  }

  void see(const ff::Position& position, int64_t now_ns) noexcept {
    newest_.store({position, now_ns + std::min(now_ns - seen_ns_, kLongest_ns)});
    seen_ns_ = now_ns;
  }

  /// Moves to where the position is at this time.
  void advance(int64_t now_ns) noexcept {
    newest_.try_load(aim_);  // keeps the previous one while a new one is being written
    const Eigen::Vector2d to = share_of(aim_.position);
    const auto passed_ns = static_cast<double>(now_ns - shown_ns_);
    const auto left_ns = static_cast<double>(aim_.arrival_ns - shown_ns_);
    shown_ =
        passed_ns >= left_ns ? to : Eigen::Vector2d(shown_ + passed_ns / left_ns * (to - shown_));
    shown_ns_ = now_ns;
  }

  /// Right and up, −1 … 1, as of the last advance().
  const Eigen::Vector2d& share() const noexcept { return shown_; }
  /// See ff::Position, as of the last advance().
  uint32_t buttons() const noexcept { return aim_.position.buttons; }

 private:
  struct Aim {
    ff::Position position;
    int64_t arrival_ns = 0;
  };

  static Eigen::Vector2d share_of(const ff::Position& position) noexcept {
    return Eigen::Vector2d(position.right, position.up) / ff::Position::kFull;
  }

  int64_t seen_ns_ = 0;
  Seqlock<Aim> newest_;
  Aim aim_;
  Eigen::Vector2d shown_ = Eigen::Vector2d::Zero();
  int64_t shown_ns_ = 0;
};

}  // namespace spidar
