// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Statistics of the answers.
#pragma once

#include <string>
#include <vector>

#include "apps/study/answers.h"

namespace study {

struct Interval {
  double low = 0, high = 1;
};

/// P(X ≤ k) for n trials with probability p each.
double binomial_cdf(int k, int n, double p);

/// Exact (Clopper–Pearson, Biometrika 26, 1934) 95 % interval for a share of which `k` of `n` were
/// counted; 0 … 1 when n is 0.
Interval share_interval(int k, int n);

/// Two-sided p value of the exact sign test, for `more` positive and `less` negative differences; 1
/// when there are none.
double sign_test(int more, int less);

/// One question in one condition. Table 1 of the paper gives the percentage of good answers, Table
/// 2 the mean.
struct Rating {
  std::string question;
  Condition condition = Condition::kLinear;
  int answers = 0;
  int counts[kSteps] = {};  ///< of each step
  int good = 0;             ///< kFirstGood and above
  double mean = 0;          ///< weighted average of steps 1 … 5
};

/// One question in both conditions. A participant counts as higher when the mean over the clips
/// that were seen in both conditions is higher in the second one (linear → nonlinear, without →
/// with).
struct Comparison {
  std::string question;
  int higher = 0, lower = 0, equal = 0;
  double p = 1;             ///< sign_test(); participants who are equal do not count
  Interval share_higher{};  ///< of those that differ
};

/// In the order in which questions and conditions first appear, the first condition first.
std::vector<Rating> ratings(const std::vector<Answer>& answers);
std::vector<Comparison> comparisons(const std::vector<Answer>& answers);

/// Prints tables.
std::string report(const std::vector<Answer>& answers);

}  // namespace study
