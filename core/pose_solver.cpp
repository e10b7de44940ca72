#include "core/pose_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/small_ldlt.h"

namespace spidar {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The error after a Gauss–Newton step is about half its square over the string length: 50 µm leave
// less than 0.06 µm at 2 cm, a hundredth of what the quantisation of an encoder leaves.
constexpr double kLastStep_m = 50e-6;
constexpr int kMaxTrackingSteps = 4;
// A hand does not reach 1000 m/s²: at 1 kHz the grip is within half a millimetre of where its
// motion leads to. Further off, a string may be at fault in a direction in which the residual does
// not show it; it is when the pose without it is this much nearer.
constexpr double kImplausible_m = 1e-3;
constexpr double kMuchNearer = 0.25;
// A cold start is polished further: it decides between minima.
constexpr double kLastSearchStep_m = 1e-9;
constexpr int kMaxSearchSteps = 40;
constexpr double kNoCost_m2 = 1e-24;
constexpr double kLittleDamping = 1e-4;
// No step of the search is longer: the model is linear over some centimetres only.
constexpr double kLongestStep_m = 0.02;
// Near the walls of the frame wrong minima go down to 20 µm; what quantisation leaves of a right
// one is some 3 µm. In between, the other starts are tried as well and the best wins.
constexpr double kSureResidual_m = 10e-6;
// Another string explains the lengths as well when its fit is not this much worse.
constexpr double kUnambiguous = 3;
// A dead encoder fits by chance when the grip passes through; a mended string goes on fitting.
constexpr int kTicksToTrust = 100;

using Weights = StringVector;

Weights weights(int count, int left_out) {
  Weights w = Weights::Zero();
  w.head(count).setOnes();
  if (left_out >= 0) w[left_out] = 0;
  return w;
}

bool newton_step(const NormalEquations& equations, double damping, Twist& step) {
  constexpr int kAll[6] = {0, 1, 2, 3, 4, 5};
  return solve_ldlt<6>(equations.H, damping, kAll, equations.g, step.data());
}

double decrease(const NormalEquations& equations, const Twist& step) {
  return Eigen::Map<const Twist>(equations.g).dot(step);
}

// Rotations by 1 rad about the axes and the diagonals of the cube: no pose within 80° is further
// than 0.7 rad from one of them or from none.
Pose restart(int n) {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  if (n < 6) {
    axis[n / 2] = n % 2 ? -1 : 1;
  } else {
    for (int k = 0; k < 3; ++k) axis[k] = ((n - 6) >> k & 1 ? 1 : -1) / std::sqrt(3.0);
  }
  Pose pose;
  pose.orientation = Eigen::AngleAxisd(1.0, axis);
  return pose;
}
constexpr int kRestarts = 14;

}  // namespace

PoseSolver::PoseSolver(const StringGeometry& geometry, double max_residual_m)
    : model_(geometry), geometry_(geometry), max_residual_m_(max_residual_m) {
  if (geometry.count < 6)
    throw std::invalid_argument("a pose has six unknowns and needs at least six strings, not " +
                                std::to_string(geometry.count));
  if (!(geometry.grip_radius_m() > 0))
    throw std::invalid_argument(
        "strings that all meet in the grip's origin do not tell how it is "
        "turned: at least one must be tied away from it");
}

void PoseSolver::reset(const Pose& pose) noexcept {
  last_ = pose;
  motion_.setZero();
  tracking_ = false;
  faulty_string_ = -1;
  fitting_ticks_ = 0;
}

bool PoseSolver::are_lengths(const StringVector& lengths_m) const noexcept {
  bool good = true;
  for (int i = 0; i < geometry_.count; ++i)
    good &= lengths_m[i] >= 0 && lengths_m[i] <= std::numeric_limits<double>::max();
  return good;
}

bool PoseSolver::is_good(const Fit& fit) const noexcept {
  return fit.converged && fit.residual_m <= max_residual_m_;
}

PoseSolver::Fit PoseSolver::gauss_newton(const StringVector& lengths_m, const Pose& start,
                                         int left_out) const noexcept {
  const Weights w = weights(geometry_.count, left_out);
  const int used = geometry_.count - (left_out >= 0);
  Fit fit{start, 0, 0, false};
  NormalEquations equations;
  while (fit.iterations < kMaxTrackingSteps && !fit.converged) {
    ++fit.iterations;
    model_.linearise(fit.pose, lengths_m.data(), w.data(), equations);
    Twist step;
    if (!newton_step(equations, 0, step)) break;
    fit.pose = model_.moved(fit.pose, step);
    // Of the linear model after the step, which is the true one where the step is short.
    const double cost_m2 = std::max(0.0, equations.cost_m2 - decrease(equations, step));
    fit.residual_m = model_.rms_m(cost_m2, used);
    fit.converged = step.squaredNorm() <= kLastStep_m * kLastStep_m;
  }
  return fit;
}

PoseSolver::Fit PoseSolver::levenberg_marquardt(const StringVector& lengths_m, const Pose& start,
                                                int left_out) const noexcept {
  const Weights w = weights(geometry_.count, left_out);
  const int used = geometry_.count - (left_out >= 0);
  Fit fit{start, 0, 0, false};
  NormalEquations equations;
  model_.linearise(fit.pose, lengths_m.data(), w.data(), equations);
  double damping = 0;
  while (fit.iterations < kMaxSearchSteps && !fit.converged) {
    ++fit.iterations;
    Twist step;
    if (!newton_step(equations, damping, step)) {
      damping = std::max(kLittleDamping, 10 * damping);
      continue;
    }
    const double length_m = step.norm();
    if (length_m > kLongestStep_m) step *= kLongestStep_m / length_m;
    const Pose pose = model_.moved(fit.pose, step);
    NormalEquations there;
    model_.linearise(pose, lengths_m.data(), w.data(), there);
    // A step that damping has shortened says nothing about how near the minimum is.
    fit.converged =
        (length_m <= kLastSearchStep_m && damping <= kLittleDamping) || there.cost_m2 <= kNoCost_m2;
    if (there.cost_m2 < equations.cost_m2) {
      fit.pose = pose;
      equations = there;
      damping = damping > 1e-6 ? damping / 10 : 0;
    } else {
      damping = std::max(kLittleDamping, 10 * damping);
    }
  }
  fit.residual_m = model_.rms_m(equations.cost_m2, used);
  return fit;
}

PoseSolver::Fit PoseSolver::search(const StringVector& lengths_m) const noexcept {
  Fit best = levenberg_marquardt(lengths_m, last_, -1);
  for (int n = 0; n < kRestarts && !(best.converged && best.residual_m <= kSureResidual_m); ++n) {
    const Fit fit = levenberg_marquardt(lengths_m, restart(n), -1);
    const int iterations = best.iterations + fit.iterations;
    if (fit.residual_m < best.residual_m) best = fit;
    best.iterations = iterations;
  }
  return best;
}

// One of seven strings always fits a little: which one is at fault is told by how far the pose of
// the others is from where the grip must be.
PoseResult PoseSolver::track_without_one(const StringVector& lengths_m,
                                         const Pose& expected) const noexcept {
  PoseResult result = rejected(PoseStatus::kNotConverged);
  if (geometry_.count < 8) return result;  // six strings fit whatever they say
  double nearest_m = kInfinity;
  for (int i = 0; i < geometry_.count; ++i) {
    const Fit fit = gauss_newton(lengths_m, expected, i);
    result.iterations += fit.iterations;
    const double distance_m = model_.twist(expected, fit.pose).norm();
    if (!is_good(fit) || distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    result.pose = fit.pose;
    result.residual_m = fit.residual_m;
    result.faulty_string = i;
    result.status = PoseStatus::kSolved;
  }
  return result;
}

// Without an expectation only the residual tells, where it does.
PoseResult PoseSolver::locate_without_one(const StringVector& lengths_m,
                                          const Pose& start) const noexcept {
  PoseResult result = rejected(PoseStatus::kNotConverged);
  if (geometry_.count < 8) return result;
  Fit best{last_, kInfinity, 0, false};
  double second_m = best.residual_m;
  int left_out = -1;
  for (int i = 0; i < geometry_.count; ++i) {
    const Fit fit = levenberg_marquardt(lengths_m, start, i);
    result.iterations += fit.iterations;
    second_m = std::min(second_m, std::max(fit.residual_m, best.residual_m));
    if (fit.residual_m >= best.residual_m) continue;
    best = fit;
    left_out = i;
  }
  if (is_good(best) && second_m > kUnambiguous * best.residual_m)
    return {best.pose, best.residual_m, result.iterations, left_out, PoseStatus::kSolved};
  return result;
}

bool PoseSolver::fits(const StringVector& lengths_m, const Pose& pose, int string) const noexcept {
  const double error_m = string_lengths_m(geometry_, pose)[string] - lengths_m[string];
  return std::abs(error_m) <= max_residual_m_;
}

PoseResult PoseSolver::rejected(PoseStatus status) const noexcept {
  PoseResult result;
  result.pose = last_;
  result.status = status;
  return result;
}

PoseResult PoseSolver::accepted(const PoseResult& result) noexcept {
  motion_ = tracking_ ? model_.twist(last_, result.pose) : Twist(Twist::Zero());
  last_ = result.pose;
  tracking_ = true;
  faulty_string_ = result.faulty_string;
  return result;
}

PoseResult PoseSolver::track(const StringVector& lengths_m) noexcept {
  if (!are_lengths(lengths_m)) return rejected(PoseStatus::kBadInput);
  const Pose expected = tracking_ ? model_.moved(last_, motion_) : last_;
  const Fit fit = gauss_newton(lengths_m, expected, faulty_string_);
  PoseResult result = rejected(PoseStatus::kNotConverged);
  if (is_good(fit)) result = {fit.pose, fit.residual_m, 0, faulty_string_, PoseStatus::kSolved};

  const double distance_m = model_.twist(expected, fit.pose).norm();
  if (tracking_ && (!is_good(fit) || distance_m > kImplausible_m)) {
    const PoseResult seven = track_without_one(lengths_m, expected);
    result.iterations = seven.iterations;
    const double limit_m = is_good(fit) ? kMuchNearer * distance_m : kInfinity;
    if (seven.status == PoseStatus::kSolved && model_.twist(expected, seven.pose).norm() <= limit_m)
      result = seven;
  }
  result.iterations += fit.iterations;
  if (result.status == PoseStatus::kNotConverged) {
    result.residual_m = fit.residual_m;
    tracking_ = false;
    return result;
  }
  const bool fitting = faulty_string_ >= 0 && faulty_string_ == result.faulty_string &&
                       fits(lengths_m, result.pose, faulty_string_);
  fitting_ticks_ = fitting ? fitting_ticks_ + 1 : 0;
  if (fitting_ticks_ >= kTicksToTrust) result.faulty_string = -1;
  return accepted(result);
}

PoseResult PoseSolver::locate(const StringVector& lengths_m) noexcept {
  if (!are_lengths(lengths_m)) return rejected(PoseStatus::kBadInput);
  tracking_ = false;
  const Fit fit = search(lengths_m);
  if (is_good(fit))
    return accepted({fit.pose, fit.residual_m, fit.iterations, -1, PoseStatus::kSolved});
  PoseResult result = locate_without_one(lengths_m, fit.pose);
  result.iterations += fit.iterations;
  if (result.status == PoseStatus::kSolved) return accepted(result);
  result.residual_m = fit.residual_m;
  return result;
}

PoseResult PoseSolver::solve(const StringVector& lengths_m) noexcept {
  const PoseResult tracked = track(lengths_m);
  if (tracked.status != PoseStatus::kNotConverged) return tracked;
  PoseResult located = locate(lengths_m);
  located.iterations += tracked.iterations;
  return located;
}

}  // namespace spidar
