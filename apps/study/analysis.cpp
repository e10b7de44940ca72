// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/study/analysis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

namespace study {
namespace {

constexpr double kTail = 0.025;  // probability in each tail of a 95 % interval

/// The p at which the monotonic function `rising` reaches `value`.
template <typename Function>
double solve(Function&& rising, double value) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {  // to the precision of a double
    const double middle = (low + high) / 2;
    (rising(middle) < value ? low : high) = middle;
  }
  return (low + high) / 2;
}

bool is_second(Condition condition) {
  return condition == Condition::kNonlinear || condition == Condition::kWith;
}

std::vector<std::string> question_names(const std::vector<Answer>& answers) {
  std::vector<std::string> names;
  for (const Answer& answer : answers) {
    // A free question may be asked in both parts and then counts as a question of its own in each.
    const std::string name = std::string(to_string(answer.trial.part)) + ": " + answer.question;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

bool is_of(const Answer& answer, const std::string& name) {
  return std::string(to_string(answer.trial.part)) + ": " + answer.question == name;
}

/// Sum of the differences second − first of one participant over the clips that have both answers.
double difference(const std::vector<Answer>& answers, const std::string& question,
                  const std::string& participant, int& pairs) {
  std::map<std::string, std::pair<int, int>> clips;
  for (const Answer& answer : answers) {
    if (answer.participant != participant || !is_of(answer, question)) continue;
    auto& [first, second] = clips[answer.trial.clip];
    (is_second(answer.trial.condition) ? second : first) = answer.step;
  }
  double sum = 0;
  pairs = 0;
  for (const auto& [clip, steps] : clips) {
    if (steps.first == 0 || steps.second == 0) continue;
    sum += steps.second - steps.first;
    ++pairs;
  }
  return sum;
}

}  // namespace

double binomial_cdf(int k, int n, double p) {
  if (k < 0) return 0;
  if (k >= n) return 1;
  if (p <= 0) return 1;
  if (p >= 1) return 0;
  double sum = 0;
  for (int i = 0; i <= k; ++i) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                    i * std::log(p) + (n - i) * std::log1p(-p));
  }
  return std::min(sum, 1.0);
}

Interval share_interval(int k, int n) {
  Interval interval;
  if (n <= 0) return interval;
  if (k > 0) interval.low = solve([&](double p) { return 1 - binomial_cdf(k - 1, n, p); }, kTail);
  if (k < n) interval.high = solve([&](double p) { return 1 - binomial_cdf(k, n, p); }, 1 - kTail);
  return interval;
}

double sign_test(int more, int less) {
  return std::min(1.0, 2 * binomial_cdf(std::min(more, less), more + less, 0.5));
}

std::vector<Rating> ratings(const std::vector<Answer>& answers) {
  std::vector<Rating> result;
  for (const std::string& question : question_names(answers)) {
    Rating first, second;
    first.question = second.question = question;
    for (const Answer& answer : answers) {
      if (!is_of(answer, question)) continue;
      Rating& rating = is_second(answer.trial.condition) ? second : first;
      rating.condition = answer.trial.condition;
      ++rating.answers;
      ++rating.counts[answer.step - 1];
      rating.good += answer.step >= kFirstGood;
      rating.mean += answer.step;
    }
    for (Rating* rating : {&first, &second}) {
      if (rating->answers == 0) continue;
      rating->mean /= rating->answers;
      result.push_back(*rating);
    }
  }
  return result;
}

std::vector<Comparison> comparisons(const std::vector<Answer>& answers) {
  std::vector<std::string> participants;
  for (const Answer& answer : answers) {
    if (index_of(answers, answer.participant) == static_cast<int>(participants.size())) {
      participants.push_back(answer.participant);
    }
  }
  std::vector<Comparison> result;
  for (const std::string& question : question_names(answers)) {
    Comparison comparison;
    comparison.question = question;
    for (const std::string& participant : participants) {
      int pairs = 0;
      const double sum = difference(answers, question, participant, pairs);
      if (pairs == 0) continue;
      ++(sum > 0 ? comparison.higher : sum < 0 ? comparison.lower : comparison.equal);
    }
    comparison.p = sign_test(comparison.higher, comparison.lower);
    comparison.share_higher =
        share_interval(comparison.higher, comparison.higher + comparison.lower);
    result.push_back(comparison);
  }
  return result;
}

std::string report(const std::vector<Answer>& answers) {
  std::string text =
      "question                   condition   answers   bad  poor   avg  good very   good %  "
      "mean\n";
  char line[200];
  for (const Rating& rating : ratings(answers)) {
    std::snprintf(line, sizeof line, "%-26s %-11s %7d %5d %5d %5d %5d %4d   %6.0f  %4.2f\n",
                  rating.question.c_str(), to_string(rating.condition), rating.answers,
                  rating.counts[0], rating.counts[1], rating.counts[2], rating.counts[3],
                  rating.counts[4], 100.0 * rating.good / rating.answers, rating.mean);
    text += line;
  }
  text +=
      "\ngood: average and better, as the paper counts. Below: participants whose mean is higher "
      "or "
      "lower\nwith nonlinear (with haptics); exact sign test, two-sided; share of those that "
      "differ "
      "with 95 %.\n\n"
      "question                    higher  lower  equal        p   share higher\n";
  for (const Comparison& c : comparisons(answers)) {
    const int different = c.higher + c.lower;
    char share[40] = "-";
    if (different > 0) {
      std::snprintf(share, sizeof share, "%.2f (%.2f to %.2f)",
                    static_cast<double>(c.higher) / different, c.share_higher.low,
                    c.share_higher.high);
    }
    std::snprintf(line, sizeof line, "%-26s %7d %6d %6d  %7.3g   %s\n", c.question.c_str(),
                  c.higher, c.lower, c.equal, c.p, share);
    text += line;
  }
  return text;
}

}  // namespace study
