// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/tension_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/grip/matrices.h"

namespace spidar {
namespace {

/// ½‖A t − b‖² + ½ε‖t − t_ref‖² with A = S W, b = S f.
struct TensionObjective {
  StructureMatrix A;
  Eigen::Matrix<double, 6, 1> b;
  Eigen::Matrix<double, kMaxStrings, kMaxStrings> Q;  ///< AᵀA + εI
  StringVector c;  ///< Aᵀb + ε t_ref: the gradient is Q t − c
  double epsilon;
  const StringVector& reference;

  /// All eight strings of `p` are used. `p` must outlive the objective.
  explicit TensionObjective(const TensionProblem& p) noexcept
      : A(p.W), b(p.wrench.stacked()), epsilon(p.epsilon), reference(p.t_ref_N) {
    A.bottomRows<3>() *= 1 / p.torque_length_m;
    b.tail<3>() *= 1 / p.torque_length_m;
    Q.noalias() = A.transpose() * A;
    Q.diagonal().array() += epsilon;
    c = epsilon * reference;
    c.noalias() += A.transpose() * b;
  }

  /// False when W, f, t_ref, ε or ℓ were not finite, or so large that their squares are not: all of
  /// them are terms of c and of the diagonal of Q.
  bool is_finite() const noexcept { return Q.diagonal().allFinite() && c.allFinite(); }

  /// False when c is zero: neither a wrench nor t_ref draws the tensions away from zero.
  bool has_pull() const noexcept { return (c.array() != 0).any(); }

  /// residual = A t − b, gradient = Aᵀ residual + ε (t − t_ref).
  void evaluate(const StringVector& t, Eigen::Matrix<double, 6, 1>& residual,
                StringVector& gradient) const noexcept {
    residual = -b;
    residual.noalias() += A * t;
    gradient = epsilon * (t - reference);
    gradient.noalias() += A.transpose() * residual;
  }

  /// Largest Qᵢᵢ|tᵢ| + |cᵢ|: the size of the terms that cancel in the gradient.
  double gradient_scale(const StringVector& t) const noexcept {
    return (Q.diagonal().cwiseProduct(t.cwiseAbs()) + c.cwiseAbs()).maxCoeff();
  }
};

constexpr int kStrings = kMaxStrings;

// A violation of the optimality conditions below this fraction of the terms of the gradient counts
// as none, because rounding alone changes the gradient by some 1e-15 of these terms.
constexpr double kTolerance = 2e-14;
// The largest violation that still counts as a solution when rounding prevents a smaller one.
constexpr double kAccepted = 1e-12;
constexpr int kMaxIterations = 24;
// A string leaves its bound when its gradient is at least this fraction of the largest one among
// the strings that should leave. If strings left one at a time, more rounds would be needed; if all
// left at once, some would return.
constexpr double kReleaseFraction = 0.4;
// Added to the diagonal (as a fraction of it) when rounding loses ε beside it; rises until the
// pivots are sound.
constexpr double kMinDamping = 0x1p-48;

// Feasible tensions, their gradient, and which strings may move (bit i: string i).
struct Iterate {
  StringVector t, gradient;
  Eigen::Matrix<double, 6, 1> residual;
  unsigned free;
};

struct Bounds {
  const StringVector& low;
  const StringVector& high;

  // The difference of bounds that are crossed or not finite is negative, infinite or NaN.
  bool are_valid() const {
    const StringVector room_N = high - low;
    return room_N.allFinite() && room_N.minCoeff() >= 0;
  }

  // NaN becomes the lower bound.
  double clamp(int i, double t) const { return std::min(std::max(low[i], t), high[i]); }

  // Strings whose bounds differ.
  unsigned apart() const {
    unsigned strings = 0;
    for (int i = 0; i < kStrings; ++i) strings |= static_cast<unsigned>(low[i] < high[i]) << i;
    return strings;
  }
};

// Starts at the nearest feasible point; strings that are at no bound are free.
void start(const Bounds& bounds, const StringVector& tension, Iterate& x) {
  x.free = 0;
  for (int i = 0; i < kStrings; ++i) {
    x.t[i] = bounds.clamp(i, tension[i]);
    x.free |= static_cast<unsigned>(bounds.low[i] < x.t[i] && x.t[i] < bounds.high[i]) << i;
  }
}

TensionProblem with_eight_strings(const TensionProblem& p) {
  TensionProblem padded = p;
  padded.count = kStrings;
  for (int i = p.count; i < kStrings; ++i) {
    padded.W.col(i).setZero();
    padded.t_min_N[i] = padded.t_max_N[i] = padded.t_ref_N[i] = 0;
  }
  return padded;
}

StringVector tension_at_rest(const TensionProblem& p) {
  StringVector t = StringVector::Zero();
  for (int i = 0; i < std::min(p.count, kStrings); ++i) {
    if (std::isfinite(p.t_min_N[i])) t[i] = p.t_min_N[i];
  }
  return t;
}

StringVector violations(const Bounds& bounds, const Iterate& x) {
  StringVector violation;
  for (int i = 0; i < kStrings; ++i) {
    const double decrease = x.t[i] > bounds.low[i] ? x.gradient[i] : 0;
    const double increase = x.t[i] < bounds.high[i] ? -x.gradient[i] : 0;
    violation[i] = std::max(decrease, increase);
  }
  return violation;
}

// A step to the minimum over the free strings: t[index] − length.
struct Step {
  int count = 0;
  int index[kStrings];
  double length[kStrings];
};

Step newton_step(const TensionObjective& objective, const Iterate& x) {
  Step step;
  for (int i = 0; i < kStrings; ++i) {
    step.index[step.count] = i;
    step.count += static_cast<int>(x.free >> i & 1);
  }
  double damping = 0;
  while (
      !solve_ldlt(step.count, objective.Q, damping, step.index, x.gradient.data(), step.length) &&
      damping < 1) {
    damping = damping > 0 ? 4 * damping : kMinDamping;
  }
  return step;
}

// Takes the whole step, clipped to the bounds. Returns the clipped strings.
unsigned go_clipped(const Bounds& bounds, const Iterate& x, const Step& step, Iterate& next) {
  next.t = x.t;
  unsigned clipped = 0;
  for (int a = 0; a < step.count; ++a) {
    const int i = step.index[a];
    const double whole = x.t[i] - step.length[a];
    next.t[i] = bounds.clamp(i, whole);
    clipped |= static_cast<unsigned>(next.t[i] != whole) << i;
  }
  next.free = x.free & ~clipped;
  return clipped;
}

// The change of the objective, from `x` to `next`, exact because the objective is quadratic.
double change(const Iterate& x, const Iterate& next) {
  return (next.t - x.t).dot(x.gradient + next.gradient) / 2;
}

// Takes the step up to the first bound, and holds the string that meets it.
void go_to_first_bound(const Bounds& bounds, const Step& step, Iterate& x) {
  double fraction = 1;
  int first = -1;
  for (int a = 0; a < step.count; ++a) {
    const int i = step.index[a];
    const double room = x.t[i] - (step.length[a] > 0 ? bounds.low[i] : bounds.high[i]);
    if (step.length[a] != 0 && room / step.length[a] < fraction) {
      fraction = room / step.length[a];
      first = a;
    }
  }
  for (int a = 0; a < step.count; ++a) {
    const int i = step.index[a];
    x.t[i] = bounds.clamp(i, x.t[i] - fraction * step.length[a]);
  }
  if (first < 0) return;
  const int i = step.index[first];
  x.t[i] = step.length[first] > 0 ? bounds.low[i] : bounds.high[i];
  x.free &= ~(1u << i);
}

unsigned strings_to_release(const Iterate& x, const StringVector& violation, double fraction) {
  double largest = 0;
  for (int i = 0; i < kStrings; ++i) {
    if (!(x.free >> i & 1)) largest = std::max(largest, violation[i]);
  }
  unsigned released = 0;
  for (int i = 0; i < kStrings; ++i) {
    if (violation[i] > 0 && violation[i] >= fraction * largest) released |= 1u << i;
  }
  return released & ~x.free;
}

// A projected Newton method: each round goes to the minimum over the free strings, clipped to the
// bounds, holds the strings that were clipped, and releases those whose gradient points inwards
// (Bertsekas, Projected Newton methods, SIAM J. Control Optim. 20, 1982). When clipping raises the
// objective, the round goes to the first bound only, as a primal active-set method does.
class Search {
 public:
  int iterations = 0;
  double violation = 0;  // the largest one, of the optimality conditions
  double scale = 0;      // of the terms that cancel in the gradient

  Search(const TensionObjective& objective, const Bounds& bounds, const StringVector& tension)
      : objective_(objective), bounds_(bounds) {
    start(bounds, tension, *x_);
  }

  // Which strings end at a bound is unknown, so all whose bounds differ are free at first.
  void free_all() { x_->free = bounds_.apart(); }

  const Iterate& result() const { return *x_; }

  void run() {
    objective_.evaluate(x_->t, x_->residual, x_->gradient);
    bool cautious = false;
    while (iterations < kMaxIterations) {
      ++iterations;
      const Step step = newton_step(objective_, *x_);
      const unsigned clipped = go_clipped(bounds_, *x_, step, *next_);
      objective_.evaluate(next_->t, next_->residual, next_->gradient);
      // The first round may raise the objective, because the start is only a guess.
      if (clipped && iterations > 1 && !(change(*x_, *next_) < 0)) {
        go_to_first_bound(bounds_, step, *x_);
        objective_.evaluate(x_->t, x_->residual, x_->gradient);
        cautious = true;
        continue;
      }
      std::swap(x_, next_);
      const StringVector violation_of = violations(bounds_, *x_);
      violation = violation_of.maxCoeff();
      scale = objective_.gradient_scale(x_->t);
      if (violation <= kTolerance * scale) return;
      // After a rejected step, strings are released only at the minimum over the free strings, and
      // one at a time. Such a string moves inwards, so every release lowers the objective, no set
      // of free strings occurs twice, and the search ends.
      if (cautious && clipped && x_->free) continue;
      x_->free |= strings_to_release(*x_, violation_of, cautious ? 1.0 : kReleaseFraction);
      cautious = false;
    }
  }

 private:
  const TensionObjective& objective_;
  const Bounds& bounds_;
  Iterate iterates_[2];
  Iterate* x_ = &iterates_[0];
  Iterate* next_ = &iterates_[1];
};

bool is_valid(const TensionProblem& problem, const TensionObjective& objective,
              const Bounds& bounds) {
  return problem.count == kStrings && problem.epsilon > 0 && problem.torque_length_m > 0 &&
         objective.is_finite() && bounds.are_valid();
}

// The result for a problem that is not valid, or whose numbers overflow.
TensionResult no_solution(const TensionProblem& problem) {
  TensionResult result;
  result.tension_N = tension_at_rest(problem);
  return result;
}

TensionResult describe(const TensionProblem& problem, const TensionObjective& objective,
                       const Search& search) {
  const Iterate& x = search.result();
  const double sum = x.residual.squaredNorm();
  // The bounds or the start were so large that W t overflowed; the search compared NaN.
  if (!std::isfinite(sum)) return no_solution(problem);
  TensionResult result;
  result.iterations = search.iterations;
  result.kkt_residual = search.scale > 0 ? search.violation / search.scale : search.violation;
  result.status =
      result.kkt_residual <= kAccepted ? TensionStatus::kSolved : TensionStatus::kIterationLimit;
  result.residual_N = std::sqrt(sum);
  result.tension_N = x.t;
  const Eigen::Matrix<double, 6, 1> delivered = x.residual + objective.b;
  result.delivered = {delivered.head<3>(), delivered.tail<3>() * problem.torque_length_m};
  return result;
}

}  // namespace

TensionResult TensionSolver::solve(const TensionProblem& problem) noexcept {
  if (problem.count > 0 && problem.count < kStrings) return solve(with_eight_strings(problem));
  const TensionObjective objective(problem);
  const Bounds bounds{problem.t_min_N, problem.t_max_N};
  TensionResult result;
  if (is_valid(problem, objective, bounds)) {
    // Without a pull, the tolerance shrinks with the tensions, and a warm start might never meet
    // it.
    const bool warm = warm_ && objective.has_pull();
    Search search(objective, bounds, warm ? last_N_ : problem.t_ref_N);
    if (!warm) search.free_all();
    search.run();
    result = describe(problem, objective, search);
  } else {
    result = no_solution(problem);
  }
  warm_ = result.status == TensionStatus::kSolved;
  if (warm_) last_N_ = result.tension_N;
  return result;
}

}  // namespace spidar
