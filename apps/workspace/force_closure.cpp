// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/workspace/force_closure.h"

#include <algorithm>

#include "core/grip/singular_values.h"

namespace {

using spidar::kMaxStrings;
using spidar::StringVector;
using Directions = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxStrings, 2>;
using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxStrings>;

// Singular values below this share of the largest count as zero: at a singular pose they are
// rounding errors, and a pose this close to one is useless.
constexpr double kRankTolerance = 1e-9;
// A smaller ratio of tensions is zero apart from rounding: the pose is on the border.
constexpr double kLeastRatio = 1e-12;
// Stands for "above zero" when a profile allows tensions of zero.
constexpr double kLeastTension_N = 1e-9;

/// Null space of `A` by columns; the second column is zero if it has dimension one. No columns when
/// A does not have rank 6 or has no null space.
bool null_space(const Columns& A, Directions& N) {
  const auto [values, V] = spidar::singular_values(A);
  const auto rest = A.cols() - 6;
  if (rest < 1 || values[5] <= kRankTolerance * values[0]) return false;
  N = Directions::Zero(A.cols(), 2);
  N.leftCols(rest) = V.rightCols(rest);
  return true;
}

/// Largest min tᵢ/lowᵢ over max tᵢ/highᵢ of all t = N d; 0 when no t is positive throughout.
///
/// With eight strings, d rotates in a plane. The directions for which all of t is positive form an
/// arc. The ratio is 0 at both ends of it and monotonic between the directions at which another
/// string becomes the smallest or the largest, so its maximum is at one of those. With seven
/// strings, d is ±(1, 0).
double best_ratio(const Directions& N, const StringVector& low, const StringVector& high) {
  const auto count = N.rows();
  const Directions L = low.head(count).cwiseInverse().asDiagonal() * N;
  const Directions H = high.head(count).cwiseInverse().asDiagonal() * N;
  double best = 0;
  const auto attempt = [&](const Eigen::Vector2d& d) {
    const double least = (L * d).minCoeff(), largest = (H * d).maxCoeff();
    if (least > kLeastRatio * largest) best = std::max(best, least / largest);
  };
  const auto attempt_both = [&](const Eigen::Vector2d& d) {
    attempt(d);
    attempt(-d);
  };
  attempt_both(Eigen::Vector2d::UnitX());
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < i; ++j) {
      attempt_both((L.row(i) - L.row(j)).transpose().unitOrthogonal());
      attempt_both((H.row(i) - H.row(j)).transpose().unitOrthogonal());
    }
  }
  return best;
}

}  // namespace

ForceClosure force_closure(const spidar::StructureMatrix& W, int count, double torque_length_m,
                           const StringVector& t_min_N, const StringVector& t_max_N) {
  Columns A = W.leftCols(count);
  A.bottomRows<3>() /= torque_length_m;
  ForceClosure closure;
  Directions N;
  if (!null_space(A, N)) return closure;
  const StringVector one = StringVector::Ones();
  closure.tension_factor = best_ratio(N, one, one);
  // t can be scaled so that the smallest tᵢ/t_minᵢ is 1; the largest tᵢ/t_maxᵢ must then be ≤ 1.
  closure.balanced_within_bounds =
      closure.tension_factor > 0 && best_ratio(N, t_min_N.cwiseMax(kLeastTension_N), t_max_N) >= 1;
  return closure;
}
