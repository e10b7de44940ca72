// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/tension_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/grip/row.h"
#include "core/grip/small_ldlt.h"
#include "core/grip/tension_objective.h"

namespace spidar {
namespace {

constexpr int n = kMaxStrings;

// A violation of the optimality conditions that counts as none, relative to the terms of the
// gradient, which is itself rounded to some 1e-15 of them.
constexpr double kTolerance = 2e-14;
// What still is a solution when rounding keeps it from getting there.
constexpr double kAccepted = 1e-12;
constexpr int kMaxIterations = 24;
// Of the strings that want to leave their bound, those leave whose gradient is this share of the
// largest: one at a time takes more rounds, all at once sends some of them back.
constexpr double kReleaseShare = 0.4;
// Added to the diagonal (as a share of it) when ε is lost beside it; rises until the pivots are
// sound.
constexpr double kLeastDamping = 0x1p-48;

// Feasible tensions, their gradient, and which strings may move (bit i: string i).
struct Iterate {
  alignas(16) Row t;
  alignas(16) Row gradient;
  double residual[6];
  unsigned free;
};

struct Bounds {
  const double* low;
  const double* high;

  // Finite, and not crossed: the difference of anything else is infinite, NaN or negative.
  bool are_valid() const {
    Pair smallest = {}, sum = {};
#pragma GCC unroll 4
    for (int p = 0; p < kPairs; ++p) {
      const Pair room = pair(high, p) - pair(low, p);
      smallest = smaller(room, smallest);
      sum += 0 * room;
    }
    return sum[0] + sum[1] == 0 && smallest[0] == 0 && smallest[1] == 0;
  }

  // NaN ends at the lower bound.
  double clamp(int i, double t) const {
    return std::min(std::max(low[i], t), high[i]);
  }

  // Strings that have room between their bounds.
  unsigned apart() const {
    unsigned strings = 0;
    for (int p = 0; p < kPairs; ++p) strings |= bits(pair(low, p) < pair(high, p), p);
    return strings;
  }
};

// The nearest feasible point; free are the strings that are at no bound.
void start(const Bounds& bounds, const double* tension, Iterate& x) {
  x.free = 0;
#pragma GCC unroll 4
  for (int p = 0; p < kPairs; ++p) {
    const Pair low = pair(bounds.low, p), high = pair(bounds.high, p);
    const Pair t = smaller(larger(pair(tension, p), low), high);
    pair(x.t, p) = t;
    x.free |= bits((low < t) & (t < high), p);
  }
}

TensionProblem with_eight_strings(const TensionProblem& p) {
  TensionProblem padded = p;
  padded.count = n;
  for (int i = p.count; i < n; ++i) {
    padded.W.col(i).setZero();
    padded.t_min_N[i] = padded.t_max_N[i] = padded.t_ref_N[i] = 0;
  }
  return padded;
}

StringVector tension_at_rest(const TensionProblem& p) {
  StringVector t = StringVector::Zero();
  for (int i = 0; i < std::min(p.count, n); ++i)
    if (std::isfinite(p.t_min_N[i])) t[i] = p.t_min_N[i];
  return t;
}

// Each string's violation of its optimality condition; returns the largest.
double violations(const Bounds& bounds, const Iterate& x, double* violation) {
#pragma GCC unroll 4
  for (int p = 0; p < kPairs; ++p) {
    const Pair g = pair(x.gradient, p);
    const Pair decrease = pair(x.t, p) > pair(bounds.low, p) ? g : Pair{};
    const Pair increase = pair(x.t, p) < pair(bounds.high, p) ? -g : Pair{};
    pair(violation, p) = larger(decrease, increase);
  }
  return largest(pair(violation, 0), pair(violation, 1), pair(violation, 2), pair(violation, 3));
}

// A step to the minimum over the free strings: t[index] − length.
struct Step {
  int count = 0;
  int index[n];
  double length[n];
};

Step newton_step(const TensionObjective& objective, const Iterate& x) {
  Step step;
  for (int i = 0; i < n; ++i) {
    step.index[step.count] = i;
    step.count += static_cast<int>(x.free >> i & 1);
  }
  double damping = 0;
  while (!solve_ldlt(step.count, objective.Q, damping, step.index, x.gradient, step.length) &&
         damping < 1)
    damping = damping > 0 ? 4 * damping : kLeastDamping;
  return step;
}

// Goes the whole step, clipped to the bounds. Returns the strings that were clipped.
unsigned go_clipped(const Bounds& bounds, const Iterate& x, const Step& step, Iterate& next) {
  for (int p = 0; p < kPairs; ++p) pair(next.t, p) = pair(x.t, p);
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

// Change of the objective from `x` to `next`; exact, as the objective is quadratic.
double change(const Iterate& x, const Iterate& next) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += (next.t[i] - x.t[i]) * (x.gradient[i] + next.gradient[i]) / 2;
  return sum;
}

// Goes along the step to the first bound in the way, and holds the string that meets it.
void go_to_first_bound(const Bounds& bounds, const Step& step, Iterate& x) {
  double share = 1;
  int first = -1;
  for (int a = 0; a < step.count; ++a) {
    const int i = step.index[a];
    const double room = x.t[i] - (step.length[a] > 0 ? bounds.low[i] : bounds.high[i]);
    if (step.length[a] != 0 && room / step.length[a] < share) {
      share = room / step.length[a];
      first = a;
    }
  }
  for (int a = 0; a < step.count; ++a) {
    const int i = step.index[a];
    x.t[i] = bounds.clamp(i, x.t[i] - share * step.length[a]);
  }
  if (first < 0) return;
  const int i = step.index[first];
  x.t[i] = step.length[first] > 0 ? bounds.low[i] : bounds.high[i];
  x.free &= ~(1u << i);
}

unsigned strings_to_release(const Iterate& x, const double* violation, double share) {
  double largest = 0;
  for (int i = 0; i < n; ++i)
    if (!(x.free >> i & 1)) largest = std::max(largest, violation[i]);
  unsigned released = 0;
  for (int i = 0; i < n; ++i)
    if (violation[i] > 0 && violation[i] >= share * largest) released |= 1u << i;
  return released & ~x.free;
}

}  // namespace

// A projected Newton method: each round goes to the minimum over the strings that may move, clipped
// to the bounds, holds those that were clipped, and lets go those whose gradient points inwards
// (Bertsekas, Projected Newton methods, SIAM J. Control Optim. 20, 1982). When clipping raises the
// objective, the round goes to the first bound only, as a primal active-set method does.
TensionResult TensionSolver::solve(const TensionProblem& problem) noexcept {
  if (problem.count > 0 && problem.count < n) return solve(with_eight_strings(problem));
  TensionResult result;
  const TensionObjective objective(problem);
  const Bounds bounds{problem.t_min_N.data(), problem.t_max_N.data()};
  if (problem.count != n || !(problem.epsilon > 0) || !(problem.torque_length_m > 0) ||
      !objective.is_finite() || !bounds.are_valid()) {
    result.tension_N = tension_at_rest(problem);
    warm_ = false;
    return result;
  }

  Iterate iterates[2];
  Iterate* x = &iterates[0];
  Iterate* next = &iterates[1];
  // Where nothing pulls the solution may be zero, which has no scale to compare leftovers of the
  // last tensions with.
  const bool warm = warm_ && objective.has_pull();
  start(bounds, warm ? last_N_.data() : problem.t_ref_N.data(), *x);
  // The strings that were at a bound stay there at first; without such knowledge all may move.
  if (!warm) x->free = bounds.apart();
  objective.evaluate(x->t, x->residual, x->gradient);

  bool cautious = false;
  double scale = 0;
  while (result.iterations < kMaxIterations) {
    ++result.iterations;
    const Step step = newton_step(objective, *x);
    const unsigned clipped = go_clipped(bounds, *x, step, *next);
    objective.evaluate(next->t, next->residual, next->gradient);
    // Where the search starts is not worth holding on to; after that the objective only falls.
    if (clipped && result.iterations > 1 && !(change(*x, *next) < 0)) {
      go_to_first_bound(bounds, step, *x);
      objective.evaluate(x->t, x->residual, x->gradient);
      cautious = true;
      continue;
    }
    std::swap(x, next);
    alignas(16) Row violation;
    result.kkt_residual = violations(bounds, *x, violation);
    scale = objective.gradient_scale(x->t);
    if (result.kkt_residual <= kTolerance * scale) break;
    // After a step that did not come off, no string is let go before the minimum over the free ones
    // is reached, and then only one: it does move inwards, so the objective falls with every such
    // release, which cannot go on for ever.
    if (cautious && clipped && x->free) continue;
    x->free |= strings_to_release(*x, violation, cautious ? 1.0 : kReleaseShare);
    cautious = false;
  }
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += x->residual[k] * x->residual[k];
  // Bounds or a start so large that W t overflows: comparisons with what is not a number say
  // nothing.
  if (!std::isfinite(sum)) {
    result = {};
    result.tension_N = tension_at_rest(problem);
    warm_ = false;
    return result;
  }
  if (scale > 0) result.kkt_residual /= scale;
  result.status =
      result.kkt_residual <= kAccepted ? TensionStatus::kSolved : TensionStatus::kIterationLimit;

  for (int p = 0; p < kPairs; ++p) pair(result.tension_N.data(), p) = pair(x->t, p);
  last_N_ = result.tension_N;
  result.residual_N = std::sqrt(sum);
  for (int k = 0; k < 3; ++k) {
    result.delivered.force_N[k] = x->residual[k] + objective.b[k];
    result.delivered.torque_Nm[k] =
        (x->residual[k + 3] + objective.b[k + 3]) * problem.torque_length_m;
  }
  warm_ = result.status == TensionStatus::kSolved;
  return result;
}

}  // namespace spidar
