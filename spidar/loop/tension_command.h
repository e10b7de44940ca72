// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// From the commanded wrench to the tension of each string.
#pragma once

#include "core/api.h"
#include "core/grip/string_geometry.h"
#include "core/grip/tension_solver.h"
#include "core/wrench.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// At rest every string has its least tension, whatever the pose: a zero wrench that is bought with
/// tension is only a zero wrench where the grip is believed to be. A wanted wrench lets the
/// tensions rise with its size, so that nothing jumps between the two. None of it allocates or
/// throws.
class SPIDAR_API TensionCommand {
 public:
  /// No string is more than this above its least tension for each newton of the wrench (its torque
  /// counts by the grip radius). More does not deliver noticeably more of the wrench within 2 cm
  /// and 20°, and makes the force on a grip that is not quite where it is believed to be wrong by
  /// more (docs/safety.md).
  static constexpr double kTensionPerForce = 4;

  explicit TensionCommand(const Profile& profile);

  /// Tensions that give `wrench` as well as they can, with the structure matrix `W` of a pose that
  /// is trusted. A wrench of zero is rest. No string is above `limit_N`.
  StringVector solve(const StructureMatrix& W, const Wrench& wrench,
                     const StringVector& limit_N) noexcept;

  /// The pose is not known: `wrench`, on its way to zero, is taken for a share of that of the last
  /// solve(), and the tensions go back to rest by as much, without W.
  StringVector fade(const Wrench& wrench) noexcept;

  /// The string that is broken, slack, or whose encoder is dead is not reckoned with from now on:
  /// as the wrench grows it goes from its least tension to none. At rest it has its least tension
  /// as the others have theirs: whether it is really broken is not known, and if it is not, seven
  /// strings would pull the grip aside. −1: none.
  void leave_out(int string) noexcept { left_out_ = string; }

  /// Of the last solve(): the share of the wrench that was asked of the strings. Below 1 where a
  /// string is out or held back, and the others alone would give another wrench.
  double share() const noexcept { return share_; }
  bool held_back() const noexcept { return share_ < 1; }

  /// At rest, with all strings.
  void reset() noexcept;

 private:
  double size_N(const Wrench& wrench) const noexcept;
  /// Sets the problem's wrench and the bounds that go with it; returns how much of their range
  /// strings are denied, 0 … 1.
  double pose_problem(const Wrench& wrench, const StringVector& limit_N) noexcept;

  const StringVector min_N_;
  const StringVector max_N_;
  TensionProblem problem_;
  TensionSolver solver_;
  int left_out_ = -1;
  StringVector last_N_;  ///< of the last solve()
  double last_size_N_ = 0;
  double share_ = 1;
};

}  // namespace spidar
