// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/pose_solver.h"

#include <limits>
#include <stdexcept>
#include <string>

#include "core/grip/matrices.h"

namespace spidar {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A hand does not reach 1000 m/s², so at 1 kHz the grip is within half a millimetre of the pose
// that its motion predicts. A pose further away may be due to a faulty string that the residual
// does not reveal. A string counts as faulty if the pose without it is this much nearer.
constexpr double kImplausible_m = 1e-3;
constexpr double kMuchNearer = 0.25;
// A string is certainly the faulty one only if leaving out any other string increases the residual
// by this factor.
constexpr double kUnambiguous = 3;
// Seven strings predict the length of the eighth. The length of each of the seven has an error of
// about a third of the largest residual, and in bad poses these errors have the same direction. So
// a correct prediction may be off by this many largest residuals.
constexpr double kMisfit = 3;
// A string is frozen if it stands still while two others have moved by kMissed largest residuals
// (about encoder steps), although it should have moved too. A fault that grows slowly has already
// shifted the expected pose when it is noticed. The distance of the pose without a frozen string is
// therefore reduced by the motion of the others, by kForgiven largest residuals at most.
constexpr double kMissed = 2;
constexpr double kForgiven = 10;
// A string that stands still while two others move by kStill largest residuals may have a dead
// encoder. An intact string also stands still for a moment when the grip turns back or moves across
// the string. But then the others predict its length to within kElsewhere largest residuals, and
// three strings never stand still together for long.
constexpr double kStill = 60;
constexpr double kLongStill = 200;
constexpr double kElsewhere = 12;
// Rounds of four Gauss–Newton steps, for six strings whose pose may be centimetres away.
constexpr int kRounds = 4;
// The weight of the residual of seven strings relative to the distance: the residual has one degree
// of freedom and the distance six, some of them weakly determined.
constexpr double kResidualWeight = 8;
// The count of a dead encoder fits by chance while the grip passes the position at which the
// encoder stopped; that of a repaired one continues to fit. An encoder that has moved this far,
// some three hundred steps, and fitted all the way is not dead. To leave its string out for longer
// would be dangerous, because the other strings may not be able to brake the grip.
constexpr int kTicksToTrust = 100;
constexpr double kMovedToTrust_m = 5e-3;

}  // namespace

PoseSolver::PoseSolver(const StringGeometry& geometry, double max_residual_m)
    : geometry_(geometry), fitter_(geometry), max_residual_m_(max_residual_m) {
  if (geometry.count < 6) {
    throw std::invalid_argument("a pose has six unknowns and needs at least six strings, not " +
                                std::to_string(geometry.count));
  }
  if (!(geometry.grip_radius_m() > 0)) {
    throw std::invalid_argument(
        "strings that all meet in the grip's origin do not tell how it is "
        "turned: at least one must be tied away from it");
  }
  const double stiffness = least_stiffness(geometry);
  if (!(stiffness >= kMinStiffness)) {
    throw std::invalid_argument(
        "strings of which none changes its length with some motion of the grip at the centre do "
        "not "
        "tell its pose: the least stiffness is " +
        std::to_string(stiffness) + ", must be " + std::to_string(kMinStiffness) + " or more");
  }
  if (!(max_residual_m > 0)) {
    throw std::invalid_argument("the largest residual must be positive, not " +
                                std::to_string(max_residual_m) + " m");
  }
}

double PoseSolver::least_stiffness(const StringGeometry& geometry) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> unit =
      structure_matrix(geometry, {}).leftCols(geometry.count);
  unit.bottomRows<3>() /= geometry.grip_radius_m();
  return singular_values(unit).values[5];
}

void PoseSolver::search_from(const Pose& pose) noexcept {
  last_ = pose;
  motion_.setZero();
  tracking_ = false;
}

void PoseSolver::reset(const Pose& pose) noexcept {
  search_from(pose);
  faulty_string_ = -1;
  fitting_ticks_ = 0;
  counts_ = {};
}

bool PoseSolver::are_lengths(const StringVector& lengths_m) const noexcept {
  bool good = true;
  for (int i = 0; i < geometry_.count; ++i) {
    good &= lengths_m[i] >= 0 && lengths_m[i] <= std::numeric_limits<double>::max();
  }
  return good;
}

bool PoseSolver::is_good(const PoseFit& fit) const noexcept {
  return fit.converged && fit.residual_m <= max_residual_m_;
}

double PoseSolver::misfit_m(const StringVector& lengths_m, const Pose& pose,
                            int string) const noexcept {
  return std::abs(string_lengths_m(geometry_, pose)[string] - lengths_m[string]);
}

double PoseSolver::residual_m(const StringVector& lengths_m, const Pose& pose,
                              int left_out) const noexcept {
  const StringVector there_m = string_lengths_m(geometry_, pose);
  double sum_m2 = 0;
  for (int i = 0; i < geometry_.count; ++i) {
    const double off_m = there_m[i] - lengths_m[i];
    if (i != left_out) sum_m2 += off_m * off_m;
  }
  return std::sqrt(sum_m2 / (geometry_.count - (left_out >= 0)));
}

// Seven strings have one redundant length, so whichever string is left out, the others fit more or
// less. The faulty string is the one without which the pose is nearest to the expected one, in
// metres. The residual of the seven counts as well, and a string whose count stands still while the
// others move is more likely to be the faulty one.
double PoseSolver::implausibility_m(const StringVector& lengths_m, const Pose& expected,
                                    const PoseFit& fit, int left_out) const noexcept {
  const double distance_m = fitter_.twist(expected, fit.pose).norm();
  const double implausibility_m = distance_m + kResidualWeight * fit.residual_m;
  const double missed_m = counts_.missed_m(lengths_m, geometry_.count, left_out);
  const bool frozen = missed_m > kMissed * max_residual_m_ &&
                      misfit_m(lengths_m, fit.pose, left_out) > kMisfit * max_residual_m_;
  return frozen ? implausibility_m - std::min(missed_m, kForgiven * max_residual_m_)
                : implausibility_m;
}

PoseResult PoseSolver::track_without_one(const StringVector& lengths_m,
                                         const Pose& expected) const noexcept {
  PoseResult result = rejected(PoseStatus::kNotConverged);
  if (geometry_.count < 8) return result;  // six strings fit any lengths
  double least_m = kInfinity;
  for (int i = 0; i < geometry_.count; ++i) {
    const PoseFit fit = fitter_.gauss_newton(lengths_m, expected, i);
    result.iterations += fit.iterations;
    if (!is_good(fit)) continue;
    const double implausible_m = implausibility_m(lengths_m, expected, fit, i);
    if (implausible_m >= least_m) continue;
    least_m = implausible_m;
    result.pose = fit.pose;
    result.residual_m = fit.residual_m;
    result.faulty_string = i;
    result.status = PoseStatus::kSolved;
  }
  return result;
}

// Without an expected pose, only the residual shows which string is faulty.
PoseResult PoseSolver::locate_without_one(const StringVector& lengths_m,
                                          const Pose& start) const noexcept {
  PoseResult result = rejected(PoseStatus::kNotConverged);
  if (geometry_.count < 8) return result;
  PoseFit best{last_, kInfinity, 0, false};
  double second_m = best.residual_m;
  int left_out = -1;
  for (int i = 0; i < geometry_.count; ++i) {
    const PoseFit fit = fitter_.levenberg_marquardt(lengths_m, start, i);
    result.iterations += fit.iterations;
    second_m = std::min(second_m, std::max(fit.residual_m, best.residual_m));
    if (fit.residual_m >= best.residual_m) continue;
    best = fit;
    left_out = i;
  }
  if (!is_good(best) || second_m <= kUnambiguous * best.residual_m) return result;
  best.iterations = result.iterations;
  return unless_ambiguous(lengths_m, best, left_out);
}

PoseResult PoseSolver::unless_ambiguous(const StringVector& lengths_m, const PoseFit& fit,
                                        int left_out) const noexcept {
  const PoseFit other = fitter_.beside(lengths_m, fit, left_out);
  PoseResult result = rejected(PoseStatus::kAmbiguous);
  if (!is_good(other)) result = {fit.pose, 0, 0, left_out, PoseStatus::kSolved};
  result.residual_m = fit.residual_m;
  result.iterations = fit.iterations + other.iterations;
  return result;
}

PoseResult PoseSolver::rejected(PoseStatus status) const noexcept {
  PoseResult result;
  result.pose = last_;
  result.status = status;
  return result;
}

PoseResult PoseSolver::rejected(PoseStatus status, const PoseResult& found) const noexcept {
  PoseResult result = rejected(status);
  result.residual_m = found.residual_m;
  result.iterations = found.iterations;
  return result;
}

PoseResult PoseSolver::accepted(const PoseResult& result) noexcept {
  motion_ = tracking_ ? fitter_.twist(last_, result.pose) : Twist(Twist::Zero());
  last_ = result.pose;
  tracking_ = true;
  faulty_string_ = result.faulty_string;
  return result;
}

// Returns the faulty string, or −1 once the string can be used again: when its length has fitted
// the pose for some time and has changed meanwhile, or has fitted while it changed a lot. The time
// alone proves nothing, because the count of a dead encoder fits as long as the grip stands still.
int PoseSolver::still_faulty(const StringVector& lengths_m, const PoseResult& result) noexcept {
  const int i = result.faulty_string;
  const bool fitting = i >= 0 && i == faulty_string_ &&
                       misfit_m(lengths_m, result.pose, i) <= kMisfit * max_residual_m_;
  if (!fitting) fitting_ticks_ = 0;
  if (!fitting) return i;
  if (fitting_ticks_++ == 0) fitting_from_m_ = lengths_m[i];
  const double moved_m = std::abs(lengths_m[i] - fitting_from_m_);
  const bool moved = moved_m > 2 * kMisfit * max_residual_m_;
  const bool trusted = moved_m > kMovedToTrust_m || (fitting_ticks_ > kTicksToTrust && moved);
  return trusted ? -1 : i;
}

// Two dead encoders may drag the pose along, because seven strings of which one is dead still fit
// closely in many positions. A string counts as dead when it has stood still while the others have
// moved, and the pose of the others predicts another length for it. If a second string is left out,
// the six that remain fit any lengths, so that no pose can be trusted.
bool PoseSolver::hides_dead_encoder(const StringVector& lengths_m, const PoseResult& result,
                                    bool tracked) const noexcept {
  int out = result.faulty_string >= 0, one = -1, other = result.faulty_string;
  for (int i = 0; i < geometry_.count; ++i) {
    if (i == result.faulty_string || !counts_.is_still(i)) continue;
    const double missed_m = counts_.missed_m(lengths_m, geometry_.count, i);
    if (missed_m <= kStill * max_residual_m_) continue;
    if (++out > 2 && missed_m > kLongStill * max_residual_m_) return true;
    (one < 0 ? one : other) = i;
  }
  if (one < 0 || other < 0) return false;  // seven strings remain
  PoseFit fit{result.pose, 0, 0, false};
  for (int round = 0; round < kRounds && !fit.converged; ++round) {
    fit = fitter_.gauss_newton(lengths_m, fit.pose, one, other);
  }
  // If the fit of the six does not converge, a tracked pose is kept, and a located one is rejected.
  if (!fit.converged) return !tracked;
  const double apart_m = fitter_.twist(fit.pose, result.pose).norm();
  const auto elsewhere = [&](int i) {
    return i != result.faulty_string &&
           misfit_m(lengths_m, fit.pose, i) > kElsewhere * max_residual_m_;
  };
  return apart_m > kImplausible_m && (elsewhere(one) || elsewhere(other));
}

// Finds the pose next to the expected one, without the string that is known to be faulty. Near the
// walls of the frame, the strings hardly determine one coordinate, and the steps of the fit stay
// long although the lengths fit. There, any pose is accepted that a hand can have reached.
PoseResult PoseSolver::follow(const StringVector& lengths_m, const Pose& expected) const noexcept {
  PoseFit fit = fitter_.gauss_newton(lengths_m, expected, faulty_string_);
  if (!fit.converged) {
    fit.converged = fitter_.twist(expected, fit.pose).norm() <= kImplausible_m;
  }
  // The residual of the linear model, which six strings always fit, is meaningless where steps are
  // long or the equations nearly singular.
  fit.residual_m = std::max(fit.residual_m, residual_m(lengths_m, fit.pose, faulty_string_));
  const PoseStatus status = is_good(fit) ? PoseStatus::kSolved : PoseStatus::kNotConverged;
  return {status == PoseStatus::kSolved ? fit.pose : last_, fit.residual_m, fit.iterations,
          status == PoseStatus::kSolved ? faulty_string_ : -1, status};
}

// Returns the pose without one string in place of `found` if `found` is no pose, or is further from
// the expected pose than a hand can move the grip. The pose without the string must be much nearer
// and predict another length for that string: near the walls, poses that are far apart have almost
// the same lengths.
PoseResult PoseSolver::unless_implausible(const StringVector& lengths_m, const Pose& expected,
                                          const PoseResult& found) const noexcept {
  const bool solved = found.status == PoseStatus::kSolved;
  const double distance_m = fitter_.twist(expected, found.pose).norm();
  if (solved && distance_m <= kImplausible_m) return found;
  PoseResult seven = track_without_one(lengths_m, expected);
  const int out = seven.faulty_string;
  if (out >= 0 && misfit_m(lengths_m, seven.pose, out) <= kMisfit * max_residual_m_) {
    if (solved) return found;
    seven.faulty_string = -1;
  }
  const double limit_m = solved ? kMuchNearer * distance_m : kInfinity;
  const bool nearer =
      seven.status == PoseStatus::kSolved && fitter_.twist(expected, seven.pose).norm() <= limit_m;
  PoseResult result = nearer ? seven : found;
  result.iterations = found.iterations + seven.iterations;
  return result;
}

PoseResult PoseSolver::track(const StringVector& lengths_m) noexcept {
  if (!are_lengths(lengths_m)) return rejected(PoseStatus::kBadInput);
  counts_.update(lengths_m, geometry_.count);
  const Pose expected = tracking_ ? fitter_.moved(last_, motion_) : last_;
  PoseResult result = follow(lengths_m, expected);
  if (tracking_) result = unless_implausible(lengths_m, expected, result);
  if (result.status == PoseStatus::kSolved && hides_dead_encoder(lengths_m, result, true)) {
    result = rejected(PoseStatus::kAmbiguous, result);
  }
  if (result.status != PoseStatus::kSolved) {
    tracking_ = false;
    return result;
  }
  result.faulty_string = still_faulty(lengths_m, result);
  return accepted(result);
}

PoseResult PoseSolver::locate(const StringVector& lengths_m) noexcept {
  if (!are_lengths(lengths_m)) return rejected(PoseStatus::kBadInput);
  tracking_ = false;
  const PoseFit fit = fitter_.search(lengths_m, last_);
  PoseResult result;
  if (is_good(fit)) {
    result = unless_ambiguous(lengths_m, fit, -1);
  } else {
    result = locate_without_one(lengths_m, fit.pose);
    result.iterations += fit.iterations;
    if (result.status == PoseStatus::kNotConverged) result.residual_m = fit.residual_m;
  }
  if (result.status != PoseStatus::kSolved) return result;
  if (hides_dead_encoder(lengths_m, result, false)) return rejected(PoseStatus::kAmbiguous, result);
  return accepted(result);
}

PoseResult PoseSolver::solve(const StringVector& lengths_m) noexcept {
  const bool guess = !tracking_;
  const Pose start = last_;
  const PoseResult tracked = track(lengths_m);
  if (tracked.status == PoseStatus::kBadInput) return tracked;
  const bool near = fitter_.twist(start, tracked.pose).norm() <= kImplausible_m;
  if (tracked.status == PoseStatus::kSolved && (near || !guess)) return tracked;
  if (guess) last_ = start;  // track() may have found the wrong one of two poses
  PoseResult located = locate(lengths_m);
  located.iterations += tracked.iterations;
  return located;
}

}  // namespace spidar
