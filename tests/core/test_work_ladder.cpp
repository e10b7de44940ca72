// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The rungs that a budget leads to, for costs that are made up.
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "core/analysis/work_ladder.h"

namespace spidar::test::work_ladder_test {
namespace {

constexpr int kRungs = WorkLadder::kLowest + 1;
using Costs = std::array<double, kRungs>;  // µs
/// The steps are about as large as those of docs/tables-tracking.md.
constexpr Costs kFilm{840, 750, 354, 266, 211};

struct Played {
  int frames = 0;
  int above = 0;
  int changes = 0;
  std::array<int, kRungs> on_rung{};
};

/// `factor` is by how much frame n is dearer than kFilm.
Played play(WorkLadder& ladder, int frames, const std::function<double(int n)>& factor) {
  Played played;
  for (; played.frames < frames; ++played.frames) {
    const int rung = ladder.rung();
    ++played.on_rung[static_cast<size_t>(rung)];
    const double cost_us = factor(played.frames) * kFilm[static_cast<size_t>(rung)];
    played.above += ladder.add(std::llround(1000 * cost_us), true);
    played.changes += ladder.rung() != rung;
  }
  return played;
}

double always(int) {
  return 1;
}

WorkLadder ladder_of(int budget_us) {
  WorkLadder ladder;
  ladder.set_budget_ns(int64_t{1000} * budget_us);
  return ladder;
}

TEST(WorkLadder, WithoutABudgetAllIsDone) {
  WorkLadder ladder;
  const Played played = play(ladder, 100, [](int) { return 1e6; });
  EXPECT_EQ(played.on_rung[0], 100);
  EXPECT_EQ(played.above, 0);
}

TEST(WorkLadder, AFilmBeginsLowAndHasAllAtOnceWhereThereIsRoom) {
  WorkLadder ladder = ladder_of(10'000);
  EXPECT_EQ(ladder.rung(), WorkLadder::kLowest);
  EXPECT_EQ(play(ladder, 10, always).changes, 1);
  EXPECT_EQ(ladder.rung(), 0);
  EXPECT_EQ(play(ladder, 1000, always).changes, 0);
}

TEST(WorkLadder, TheHighestRungThatKeepsToTheBudgetIsFound) {
  for (const auto& [budget_us, rung] :
       {std::pair{1000, 0}, {800, 1}, {500, 2}, {300, 3}, {240, 4}}) {
    SCOPED_TRACE(budget_us);
    WorkLadder ladder = ladder_of(budget_us);
    const Played played = play(ladder, 5000, always);
    EXPECT_EQ(ladder.rung(), rung);
    EXPECT_GT(played.on_rung[static_cast<size_t>(rung)], 4500);
  }
}

/// Costs of frames spread as those of films: the dearest of a hundred are 1.5 to 1.8 times the
/// median.
TEST(WorkLadder, Holds99PerCentOfUnequalFrames) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    for (const int budget_us : {420, 500, 700, 1000, 1500}) {
      SCOPED_TRACE(std::to_string(seed) + ", " + std::to_string(budget_us) + " us");
      std::mt19937 random(seed);
      std::normal_distribution<double> spread(0, 0.2);
      WorkLadder ladder = ladder_of(budget_us);
      const Played played = play(ladder, 20'000, [&](int) { return std::exp(spread(random)); });
      EXPECT_LE(played.above, 200);
    }
  }
}

/// A rung that is too dear is tried after 100, 200, … 3200 frames, of which each time costs one
/// frame above the budget and two changes: in 20 000 frames 5 + 20 000 / 3200 times at most.
TEST(WorkLadder, DoesNotFlap) {
  WorkLadder ladder = ladder_of(340);  // the next rung costs 354
  const Played played = play(ladder, 20'000, always);
  EXPECT_LE(played.changes, 2 * 12 + WorkLadder::kLowest);
  EXPECT_LE(played.above, 12);
  EXPECT_GT(played.on_rung[3], 19'000);
}

/// Two thirds of what may be above the budget. One that comes when nothing is saved, because a
/// dearer rung was tried, costs some tens of frames on lower rungs.
TEST(WorkLadder, RareSpikesHardlyChangeAnything) {
  WorkLadder ladder = ladder_of(500);
  play(ladder, 1000, always);
  const Played played = play(ladder, 20'000, [](int n) { return n % 150 == 149 ? 10.0 : 1.0; });
  EXPECT_GT(played.on_rung[2], 19'000);
  EXPECT_LE(played.above, 200);
  EXPECT_EQ(ladder.rung(), 2);
}

TEST(WorkLadder, ADearerSceneDescendsWithinAFewFramesAndACheaperOneClimbs) {
  WorkLadder ladder = ladder_of(1200);
  play(ladder, 1000, always);
  EXPECT_EQ(ladder.rung(), 0);
  // One frame is what was saved; the next ones take it down to where 3 × 266 µs fit.
  EXPECT_LE(play(ladder, 200, [](int) { return 3.0; }).above, 1 + WorkLadder::kLowest);
  EXPECT_GE(ladder.rung(), 2);
  play(ladder, 1000, always);
  EXPECT_EQ(ladder.rung(), 0);
}

TEST(WorkLadder, WhatNoRungKeepsIsCounted) {
  WorkLadder ladder = ladder_of(1);
  const Played played = play(ladder, 1000, always);
  EXPECT_EQ(played.above, 1000);
  EXPECT_EQ(played.on_rung[WorkLadder::kLowest], 1000);
}

TEST(WorkLadder, RepeatedPicturesAreNoReasonToClimb) {
  WorkLadder ladder = ladder_of(300);
  for (int n = 0; n < 1000; ++n) EXPECT_FALSE(ladder.add(1000, false));
  EXPECT_EQ(ladder.rung(), WorkLadder::kLowest);
}

TEST(WorkLadder, ABudgetThatChangesKeepsTheRungAndNoneEndsIt) {
  WorkLadder ladder = ladder_of(500);
  play(ladder, 1000, always);
  ASSERT_EQ(ladder.rung(), 2);
  ladder.set_budget_ns(1'000'000);
  EXPECT_EQ(ladder.rung(), 2);
  play(ladder, 1000, always);
  EXPECT_EQ(ladder.rung(), 0);
  ladder.set_budget_ns(300'000);
  EXPECT_EQ(ladder.rung(), 0);
  EXPECT_LE(play(ladder, 100, always).above, WorkLadder::kLowest);
  ladder.set_budget_ns(0);
  EXPECT_EQ(ladder.rung(), 0);
}

}  // namespace
}  // namespace spidar::test::work_ladder_test
