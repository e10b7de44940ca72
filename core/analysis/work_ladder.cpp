// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/work_ladder.h"

#include <algorithm>
#include <array>

namespace spidar {
namespace {

/// Cost of each rung over that of the next lower one, at most: as measured with frames of 854 × 480
/// px. It is less where reading the frame is most of the cost.
constexpr std::array<double, WorkLadder::kLowest> kDearer{1.4, 2.2, 1.7, 1.7};
/// A higher rung that costs less than this in addition is not to be expected.
constexpr double kLeastDearer = 1.1;
constexpr double kShareAbove = 0.01;
constexpr int kFirstWait = 8;  // frames
/// After a climb that failed, and before a try, which needs a whole frame saved in any case.
constexpr int kWait = 100;
constexpr int kMostWait = 3200;
/// A frame above the budget this soon after a climb shows that the climb was an error.
constexpr int kOnTrial = 100;

int longer(int wait) {
  return std::clamp(2 * wait, kWait, kMostWait);
}

}  // namespace

void WorkLadder::set_budget_ns(int64_t budget_ns) {
  if (budget_ns == budget_ns_) return;
  const bool had_limit = budget_ns_ > 0;
  budget_ns_ = std::max<int64_t>(budget_ns, 0);
  wait_ = kFirstWait;
  wait_to_try_ = since_try_ = kWait;
  since_climb_ = kOnTrial;
  if (budget_ns_ == 0 || !had_limit) {
    saved_ = 0;
    stand_on(budget_ns_ > 0 ? kLowest : 0);
  }
}

void WorkLadder::stand_on(int rung) {
  rung_ = rung;
  compared_ = 0;
  dearest_ns_ = 0;
}

bool WorkLadder::add(int64_t cost_ns, bool is_compared) {
  if (budget_ns_ == 0) return false;
  saved_ = std::min(saved_ + kShareAbove, 1.0);
  since_try_ = std::min(since_try_ + 1, kMostWait);
  if (since_climb_ < kOnTrial && ++since_climb_ == kOnTrial) {
    (has_tried_ ? wait_to_try_ : wait_) = has_tried_ ? kWait : kFirstWait;
  }
  if (cost_ns > budget_ns_) {
    if (saved_ < 1 || since_climb_ < kOnTrial) descend(cost_ns);
    saved_ = 0;
    return true;
  }
  if (!is_compared) return false;
  dearest_ns_ = std::max(dearest_ns_, cost_ns);
  if (++compared_ >= wait_) look_up();
  return false;
}

void WorkLadder::descend(int64_t cost_ns) {
  if (since_climb_ < kOnTrial) {
    int& wait = has_tried_ ? wait_to_try_ : wait_;
    wait = longer(wait);
  }
  since_climb_ = kOnTrial;
  int rung = rung_;
  auto cost = static_cast<double>(cost_ns);
  while (rung < kLowest && cost > static_cast<double>(budget_ns_)) {
    cost /= kDearer[static_cast<size_t>(rung)];
    ++rung;
  }
  stand_on(rung);
}

void WorkLadder::look_up() {
  const auto budget = static_cast<double>(budget_ns_);
  const auto dearest = static_cast<double>(dearest_ns_);
  int rung = rung_;
  for (double cost = dearest; rung > 0; --rung) {
    cost *= kDearer[static_cast<size_t>(rung) - 1];
    if (cost > budget) break;
  }
  const bool tries = rung == rung_ && rung > 0 && saved_ >= 1 && since_try_ >= wait_to_try_ &&
                     dearest * kLeastDearer <= budget;
  if (tries) {
    --rung;
    saved_ = 0;
    since_try_ = 0;
  }
  if (rung < rung_) {
    since_climb_ = 0;
    has_tried_ = tries;
  }
  stand_on(rung);
}

}  // namespace spidar
