// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The grip's pose from the lengths of its strings.
#pragma once

#include "core/api.h"
#include "core/grip/frozen_counts.h"
#include "core/grip/pose.h"
#include "core/grip/pose_fit.h"
#include "core/grip/string_geometry.h"

namespace spidar {

enum class PoseStatus {
  kSolved,
  kNotConverged,  ///< the lengths fit no pose that was found: the last good pose is returned
  /// They fit two, or only with a string that may be dead: the last good pose is returned.
  kAmbiguous,
  kBadInput,  ///< a length is negative or not finite: the last good pose is returned
};

struct PoseResult {
  Pose pose;
  double residual_m = 0;  ///< root mean square length error of the strings that were used
  int iterations = 0;     ///< linearised problems solved
  /// A slack string, a count that jumped or an encoder that is dead: this string's length fits no
  /// pose that the seven others agree on, and the pose is theirs. −1 when all fit.
  int faulty_string = -1;
  PoseStatus status = PoseStatus::kBadInput;
};

/// Least squares over the string lengths. No allocation, no exceptions after construction.
///
/// What cannot be known: a pose and another one whose lengths differ by less than the measurement
/// errs. Such pairs exist where the structure matrix is nearly singular, near the walls of the
/// frame. locate() looks for the other pose and reports kAmbiguous; track() stays with the one that
/// the motion leads to. And with eight strings two lengths are redundant, so that one fault is
/// noticed by what it does in two numbers: not at all where the other seven strings can follow it,
/// which shows as soon as the grip moves on, and two strings whose faults have the same effect on
/// both numbers are told apart by the motion and by counts that stand still only. Two dead encoders
/// leave too few strings: where counts that stand still say so, there is no pose.
class SPIDAR_API PoseSolver {
 public:
  /// A residual above this means that the solution is wrong: a local minimum or a bad length. A
  /// count errs by half an encoder step at most, and so does the residual of the right pose: 17.4
  /// µm for the coarsest encoder of the known devices.
  static constexpr double kMaxResidual_m = 20e-6;

  /// Throws std::invalid_argument when the geometry has fewer than six strings, all of them end in
  /// the grip's origin, or `max_residual_m` is not positive. `max_residual_m`: one encoder step, or
  /// what a device whose geometry is known less well needs; a fault shows when a length is off by
  /// about six times as much.
  explicit PoseSolver(const StringGeometry& geometry, double max_residual_m = kMaxResidual_m);

  /// track(), and locate() when that is lost or leads away from a start that is a guess: for every
  /// tick. The worst case is lengths that fit no pose, every time it is called; bench_pose times
  /// it.
  PoseResult solve(const StringVector& lengths_m) noexcept;

  /// The pose next to the last one: Gauss–Newton from where the last motion leads to. With eight
  /// strings, one that does not fit is left out and named; it is used again when it has fitted for
  /// 100 calls and moved.
  PoseResult track(const StringVector& lengths_m) noexcept;

  /// The pose anywhere: Levenberg–Marquardt from the last pose and from turned ones at the centre.
  PoseResult locate(const StringVector& lengths_m) noexcept;

  /// Where the next search starts. Forgets the motion, but not which counts have stood still.
  void search_from(const Pose& pose) noexcept;

  /// The same for another device, or one that was switched on again: forgets all.
  void reset(const Pose& pose = {}) noexcept;

 private:
  bool are_lengths(const StringVector& lengths_m) const noexcept;
  bool is_good(const PoseFit& fit) const noexcept;
  double implausibility_m(const StringVector& lengths_m, const Pose& expected, const PoseFit& fit,
                          int left_out) const noexcept;
  bool hides_dead_encoder(const StringVector& lengths_m, const PoseResult& result,
                          bool tracked) const noexcept;
  double misfit_m(const StringVector& lengths_m, const Pose& pose, int string) const noexcept;
  PoseResult follow(const StringVector& lengths_m, const Pose& expected) const noexcept;
  PoseResult unless_implausible(const StringVector& lengths_m, const Pose& expected,
                                const PoseResult& found) const noexcept;
  PoseResult track_without_one(const StringVector& lengths_m, const Pose& expected) const noexcept;
  PoseResult locate_without_one(const StringVector& lengths_m, const Pose& start) const noexcept;
  PoseResult unless_ambiguous(const StringVector& lengths_m, const PoseFit& fit,
                              int left_out) const noexcept;
  int still_faulty(const StringVector& lengths_m, const PoseResult& result) noexcept;
  PoseResult rejected(PoseStatus status) const noexcept;
  PoseResult rejected(PoseStatus status, const PoseResult& found) const noexcept;
  PoseResult accepted(const PoseResult& result) noexcept;

  StringGeometry geometry_;
  PoseFitter fitter_;
  double max_residual_m_;
  Pose last_;
  Twist motion_ = Twist::Zero();  ///< from the pose before the last to the last
  bool tracking_ = false;         ///< the last call found a pose
  FrozenCounts counts_;
  int faulty_string_ = -1;
  int fitting_ticks_ = 0;      ///< for how long its length has fitted again
  double fitting_from_m_ = 0;  ///< its length when that began
};

}  // namespace spidar
