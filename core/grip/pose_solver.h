// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/grip/pose_fit.h"
#include "core/grip/string_geometry.h"

namespace spidar {

/// Stores, for each string, the lengths of all strings at the last change of its own length.
class StillStrings {
 public:
  void update(const StringVector& lengths_m, int count) noexcept {
    still_ = 0;
    for (int i = 0; i < count; ++i) {
      StringVector& then = at_change_m_[static_cast<size_t>(i)];
      if (then[i] != lengths_m[i]) {
        then = lengths_m;
      } else {
        still_ |= 1u << i;
      }
    }
  }

  /// Whether string `i` did not change with the last update.
  bool is_still(int i) const noexcept { return still_ >> i & 1; }

  /// How far the strings have moved since string `i` last changed: the second largest change of
  /// length, because a single count may have jumped.
  double missed_m(const StringVector& lengths_m, int count, int i) const noexcept {
    const StringVector& then = at_change_m_[static_cast<size_t>(i)];
    double most = 0, second = 0;
    for (int k = 0; k < count; ++k) {
      const double moved = std::abs(lengths_m[k] - then[k]);
      second = std::max(second, std::min(most, moved));
      most = std::max(most, moved);
    }
    return second;
  }

 private:
  static StringVector never() noexcept { return StringVector::Constant(-1); }  // not a length

  unsigned still_ = 0;
  std::array<StringVector, kMaxStrings> at_change_m_{never(), never(), never(), never(),
                                                     never(), never(), never(), never()};
};

enum class PoseStatus {
  kSolved,
  kNotConverged,  ///< no pose was found that fits the lengths: returns the last good pose
  /// The lengths fit two poses, or one with a string that may be dead: returns the last good pose.
  kAmbiguous,
  kBadInput,  ///< a length is negative or not finite: returns the last good pose
};

struct PoseResult {
  Pose pose;
  double residual_m = 0;  ///< RMS length error of the strings that were used
  int iterations = 0;     ///< the number of linearised problems
  /// The string whose length does not fit the pose of the seven others, which is the returned pose:
  /// the string is slack, its count has jumped, or its encoder is dead. −1 when all strings fit.
  int faulty_string = -1;
  PoseStatus status = PoseStatus::kBadInput;
};

/// Computes the grip's pose from the lengths of its strings by least squares. No allocation, no
/// exceptions after construction.
///
/// Limits of what the lengths determine:
/// - Near the walls of the frame, where the structure matrix is nearly singular, two poses can have
///   lengths that differ by less than the measurement error. locate() looks for a second pose and
///   reports kAmbiguous; track() returns the pose that continues the motion.
/// - Eight strings have two redundant lengths, so a fault shows in two numbers only. A fault that a
///   wrong pose of the other seven strings explains is detected only when the grip moves on. If the
///   faults of two strings would have the same effect, the motion and frozen counts show which one
///   is faulty.
/// - Two dead encoders leave too few strings. Once frozen counts reveal them, no pose is returned.
class PoseSolver {
 public:
  /// A larger residual means that the solution is wrong: a local minimum or a bad length. Neither
  /// the error of a count nor the residual of the right pose exceeds half an encoder step, 17.4 µm
  /// for the coarsest encoder of the known devices.
  static constexpr double kMaxResidual_m = 20e-6;

  /// The smallest least_stiffness() of a usable geometry: how much the weakest of the grip's six
  /// motions at the centre changes the lengths of the strings, relative to a string that follows
  /// that motion alone. With less, no pose could be trusted. The shipped profiles have 0.2 or more.
  static constexpr double kMinStiffness = 0.02;
  /// See kMinStiffness. The geometry must have at least six strings, of which one ends away from
  /// the grip's origin.
  static double least_stiffness(const StringGeometry& geometry);

  /// Throws std::invalid_argument when the geometry has fewer than six strings, when all of them
  /// end in the grip's origin, when its least_stiffness() is below kMinStiffness, or when
  /// `max_residual_m` is not positive. `max_residual_m` is one encoder step, or more for a device
  /// whose geometry is known less well; a fault shows when a length is off by about six times as
  /// much.
  explicit PoseSolver(const StringGeometry& geometry, double max_residual_m = kMaxResidual_m);

  /// To be called on every tick. Calls track(), then locate() if tracking fails or leads away from
  /// an initial guess. The slowest case, which `spidar-bench pose` measures, is lengths that fit no
  /// pose.
  PoseResult solve(const StringVector& lengths_m) noexcept;

  /// Finds the pose near the last one, by Gauss–Newton from the pose that the last motion predicts.
  /// With eight strings, one that does not fit is left out and reported. The string is used again
  /// when its length has fitted for 100 calls with some motion, or over 5 mm of motion.
  PoseResult track(const StringVector& lengths_m) noexcept;

  /// Finds the pose anywhere in the frame, by Levenberg–Marquardt from the last pose and from
  /// turned poses at the centre.
  PoseResult locate(const StringVector& lengths_m) noexcept;

  /// Sets the start of the next search. Forgets the motion, but remembers which counts are frozen.
  void search_from(const Pose& pose) noexcept;

  /// Drops everything, for another device, or one that was switched on again.
  void reset(const Pose& pose = {}) noexcept;

 private:
  bool are_lengths(const StringVector& lengths_m) const noexcept;
  bool is_good(const PoseFit& fit) const noexcept;
  double implausibility_m(const StringVector& lengths_m, const Pose& expected, const PoseFit& fit,
                          int left_out) const noexcept;
  bool hides_dead_encoder(const StringVector& lengths_m, const PoseResult& result,
                          bool tracked) const noexcept;
  double residual_m(const StringVector& lengths_m, const Pose& pose, int left_out) const noexcept;
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
  bool tracking_ = false;         ///< whether the last call found a pose
  StillStrings counts_;
  int faulty_string_ = -1;
  int fitting_ticks_ = 0;      ///< how long the length of faulty_string_ has fitted again
  double fitting_from_m_ = 0;  ///< the length of faulty_string_ when it began to fit
};

}  // namespace spidar
