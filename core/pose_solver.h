/// The grip's pose from the lengths of its strings.
#pragma once

#include "core/api.h"
#include "core/pose.h"
#include "core/string_geometry.h"

namespace spidar {

enum class PoseStatus {
  kSolved,
  kNotConverged,  ///< the lengths fit no pose near the last one: the last good pose is returned
  kBadInput,      ///< a length is negative or not finite: the last good pose is returned
};

struct PoseResult {
  Pose pose;
  double residual_m = 0;  ///< root mean square of length errors
  int iterations = 0;
  PoseStatus status = PoseStatus::kBadInput;
};

/// Least squares over the string lengths (ceres::TinySolver), started from the last pose.
/// Needs at least six strings. No allocation, no exceptions after construction.
class SPIDAR_API PoseSolver {
 public:
  /// Throws std::invalid_argument when the geometry has fewer than six strings, or all of
  /// them end in the grip's origin.
  explicit PoseSolver(const StringGeometry& geometry);

  /// A residual above this means that the solution is wrong: a local minimum or a bad length.
  static constexpr double kMaxResidual_m = 50e-6;

  PoseResult solve(const StringVector& lengths_m) noexcept;

  /// Where the next search starts.
  void reset(const Pose& pose = {}) noexcept { last_ = pose; }

 private:
  StringGeometry geometry_;
  Pose last_;
};

}  // namespace spidar
