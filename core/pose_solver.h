/// The grip's pose from the lengths of its strings.
#pragma once

#include <array>

#include "core/api.h"
#include "core/length_model.h"
#include "core/pose.h"
#include "core/string_geometry.h"

namespace spidar {

enum class PoseStatus {
  kSolved,
  kNotConverged,  ///< the lengths fit no pose that was found: the last good pose is returned
  kBadInput,      ///< a length is negative or not finite: the last good pose is returned
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
class SPIDAR_API PoseSolver {
 public:
  /// A residual above this means that the solution is wrong: a local minimum or a bad length.
  static constexpr double kMaxResidual_m = 50e-6;

  /// Throws std::invalid_argument when the geometry has fewer than six strings, or all of them end
  /// in the grip's origin. `max_residual_m`: what a device whose geometry is known less well needs.
  explicit PoseSolver(const StringGeometry& geometry, double max_residual_m = kMaxResidual_m);

  /// track(), and locate() when that is lost: for every tick. The worst case is a pose that is not
  /// found, at most 1000 linearised problems (a tenth of a millisecond), every time it is called.
  PoseResult solve(const StringVector& lengths_m) noexcept;

  /// The pose next to the last one: Gauss–Newton from where the last motion leads to. With eight
  /// strings, one that does not fit is left out and named; it is used again when it has fitted for
  /// 100 calls.
  PoseResult track(const StringVector& lengths_m) noexcept;

  /// The pose anywhere: Levenberg–Marquardt from the last pose and from turned ones at the centre.
  PoseResult locate(const StringVector& lengths_m) noexcept;

  /// Where the next search starts. Forgets motion and faulty strings.
  void reset(const Pose& pose = {}) noexcept;

 private:
  struct Fit {
    Pose pose;
    double residual_m;
    int iterations;
    bool converged;
  };

  bool are_lengths(const StringVector& lengths_m) const noexcept;
  Fit gauss_newton(const StringVector& lengths_m, const Pose& start, int left_out) const noexcept;
  Fit levenberg_marquardt(const StringVector& lengths_m, const Pose& start,
                          int left_out) const noexcept;
  Fit search(const StringVector& lengths_m) const noexcept;
  bool is_good(const Fit& fit) const noexcept;
  bool fits(const StringVector& lengths_m, const Pose& pose, int string) const noexcept;
  PoseResult track_without_one(const StringVector& lengths_m, const Pose& expected) const noexcept;
  PoseResult locate_without_one(const StringVector& lengths_m, const Pose& start) const noexcept;
  PoseResult rejected(PoseStatus status) const noexcept;
  PoseResult accepted(const PoseResult& result) noexcept;

  LengthModel model_;
  StringGeometry geometry_;
  double max_residual_m_;
  Pose last_;
  Twist motion_ = Twist::Zero();  ///< from the pose before the last to the last
  bool tracking_ = false;         ///< the last call found a pose
  int faulty_string_ = -1;
  int fitting_ticks_ = 0;  ///< for how long its length has fitted again
};

}  // namespace spidar
