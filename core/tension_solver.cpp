#include "core/tension_solver.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace spidar {
namespace {

using Hessian = Eigen::Matrix<double, kMaxStrings, kMaxStrings>;

// Multipliers and bound violations below this share of their own terms are rounding.
constexpr double kTolerance = 1e-13;
constexpr int kMaxIterations = 100;

bool is_valid(const TensionProblem& p) {
  if (p.count < 1 || p.count > kMaxStrings) return false;
  if (!(p.epsilon > 0 && std::isfinite(p.epsilon))) return false;
  if (!(p.torque_length_m > 0 && std::isfinite(p.torque_length_m))) return false;
  if (!p.wrench.is_finite()) return false;
  for (int i = 0; i < p.count; ++i) {
    if (!p.W.col(i).allFinite() || !std::isfinite(p.t_ref_N[i])) return false;
    if (!std::isfinite(p.t_min_N[i]) || !std::isfinite(p.t_max_N[i])) return false;
    if (p.t_min_N[i] > p.t_max_N[i]) return false;
  }
  return true;
}

StringVector tension_at_rest(const TensionProblem& p) {
  StringVector t = StringVector::Zero();
  for (int i = 0; i < std::clamp(p.count, 0, kMaxStrings); ++i)
    if (std::isfinite(p.t_min_N[i])) t[i] = p.t_min_N[i];
  return t;
}

// Minimiser over the free strings with the others held where they are.
StringVector free_minimum(const Hessian& Q, const StringVector& c, int count,
                          const std::array<signed char, kMaxStrings>& bound, StringVector t) {
  std::array<int, kMaxStrings> free{};
  int n = 0;
  for (int i = 0; i < count; ++i)
    if (bound[i] == 0) free[n++] = i;
  if (n == 0) return t;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStrings, kMaxStrings> A(n, n);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStrings, 1> b(n);
  for (int a = 0; a < n; ++a) t[free[a]] = 0;
  const StringVector g = c - Q * t;
  for (int a = 0; a < n; ++a) {
    b[a] = g[free[a]];
    for (int d = 0; d < n; ++d) A(a, d) = Q(free[a], free[d]);
  }
  const auto ldlt = A.ldlt();
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStrings, 1> y = ldlt.solve(b);
  y += ldlt.solve(b - A * y);
  for (int a = 0; a < n; ++a) t[free[a]] = y[a];
  return t;
}

}  // namespace

TensionResult TensionSolver::solve(const TensionProblem& p) noexcept {
  TensionResult result;
  if (!is_valid(p)) {
    result.tension_N = tension_at_rest(p);
    warm_ = false;
    return result;
  }

  StructureMatrix A = p.W;
  Eigen::Matrix<double, 6, 1> f = p.wrench.stacked();
  A.bottomRows<3>() /= p.torque_length_m;
  f.tail<3>() /= p.torque_length_m;
  A.rightCols(kMaxStrings - p.count).setZero();
  const Hessian Q = A.transpose() * A + p.epsilon * Hessian::Identity();
  StringVector c = A.transpose() * f + p.epsilon * p.t_ref_N;
  c.tail(kMaxStrings - p.count).setZero();

  // A feasible start: strings at their remembered bound, the others clipped to theirs.
  if (!warm_) bound_.fill(0);
  StringVector t = free_minimum(Q, c, p.count, bound_, StringVector::Zero());
  for (int i = 0; i < p.count; ++i) {
    if (bound_[i] == 0 && t[i] <= p.t_min_N[i]) bound_[i] = -1;
    if (bound_[i] == 0 && t[i] >= p.t_max_N[i]) bound_[i] = 1;
    if (p.t_min_N[i] == p.t_max_N[i]) bound_[i] = -1;
    if (bound_[i] != 0) t[i] = bound_[i] < 0 ? p.t_min_N[i] : p.t_max_N[i];
  }

  result.status = TensionStatus::kIterationLimit;
  StringVector gradient;
  StringVector scale;
  while (result.iterations < kMaxIterations) {
    ++result.iterations;
    const StringVector target = free_minimum(Q, c, p.count, bound_, t);
    double step = 1;
    int blocking = -1;
    for (int i = 0; i < p.count; ++i) {
      if (bound_[i] != 0) continue;
      const double limit = target[i] < t[i] ? p.t_min_N[i] : p.t_max_N[i];
      if ((target[i] - limit) * (target[i] - t[i]) <= 0) continue;
      const double share = (limit - t[i]) / (target[i] - t[i]);
      if (share < step) {
        step = share;
        blocking = i;
      }
    }
    if (blocking >= 0) {
      const bool down = target[blocking] < t[blocking];
      t += step * (target - t);
      bound_[blocking] = down ? -1 : 1;
      t[blocking] = down ? p.t_min_N[blocking] : p.t_max_N[blocking];
      continue;
    }
    t = target;
    gradient = Q * t - c;
    scale = Q.cwiseAbs() * t.cwiseAbs() + c.cwiseAbs();
    int worst = -1;
    double worst_multiplier = kTolerance * scale.maxCoeff();
    for (int i = 0; i < p.count; ++i) {
      if (bound_[i] == 0 || p.t_min_N[i] == p.t_max_N[i]) continue;
      const double multiplier = bound_[i] * gradient[i];
      if (multiplier > worst_multiplier) {
        worst_multiplier = multiplier;
        worst = i;
      }
    }
    if (worst < 0) {
      result.status = TensionStatus::kSolved;
      break;
    }
    bound_[worst] = 0;
  }

  for (int i = 0; i < p.count; ++i) t[i] = std::clamp(t[i], p.t_min_N[i], p.t_max_N[i]);
  gradient = Q * t - c;
  scale = Q.cwiseAbs() * t.cwiseAbs() + c.cwiseAbs();
  double violation = 0;
  for (int i = 0; i < p.count; ++i) {
    const bool at_min = t[i] == p.t_min_N[i], at_max = t[i] == p.t_max_N[i];
    const double up = at_min ? 0.0 : gradient[i], down = at_max ? 0.0 : -gradient[i];
    violation = std::max({violation, up, down});
  }
  const double whole = scale.maxCoeff();
  result.kkt_residual = whole > 0 ? violation / whole : 0.0;
  result.tension_N = t;
  const Eigen::Matrix<double, 6, 1> delivered = p.W.leftCols(p.count) * t.head(p.count);
  result.delivered = {delivered.head<3>(), delivered.tail<3>()};
  result.residual_N = (A * t - f).norm();
  warm_ = result.status == TensionStatus::kSolved;
  return result;
}

}  // namespace spidar
