// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Reasons why there is no force: their texts, and which of them a second of frames has.
#include <cstring>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/analysis/force_limit.h"
#include "core/analysis/motion_analyzer.h"
#include "core/force/motion_rendering.h"

namespace spidar::test::force_limit_test {
namespace {

constexpr int64_t kFrame_ns = 40'000'000;

TEST(ForceLimit, EachHasANickOfItsOwnAndASentence) {
  std::set<std::string> nicks;
  for (size_t i = 0; i < kForceLimits; ++i) {
    const auto limit = static_cast<ForceLimit>(i);
    EXPECT_TRUE(nicks.insert(nick(limit)).second) << nick(limit);
    if (limit == ForceLimit::kNone) continue;
    EXPECT_EQ(sentence(limit)[std::strlen(sentence(limit)) - 1], '.') << nick(limit);
  }
  EXPECT_STREQ(sentence(ForceLimit::kNone), "");
  EXPECT_EQ(nicks.count("unknown"), 0u);
}

TEST(ForceLimit, TorqueCountsByItsArm) {
  Wrench wrench;
  wrench.force_N = {3, 0, 0};
  wrench.torque_Nm = {0, 0, 4 * kTorqueArm_m};
  EXPECT_NEAR(size_N(wrench), 5, 1e-12);
}

/// Frames of one reason, 40 ms apart.
class Second {
 public:
  Second& show(int count, ForceLimit limit, double force_N = 0) {
    for (int i = 0; i < count; ++i) history.add(kFrame_ns * frames_++, force_N, limit);
    return *this;
  }
  ForceLimit limit() const { return history.limit(kFrame_ns * (frames_ - 1)); }

  ForceLimitHistory history;

 private:
  int frames_ = 0;
};

TEST(ForceLimitHistory, KnowsNothingWithoutFrames) {
  EXPECT_EQ(ForceLimitHistory().limit(0), ForceLimit::kNoFrames);
}

TEST(ForceLimitHistory, TakesTheReasonThatMostPicturesHave) {
  Second second;
  second.show(4, ForceLimit::kNothingMoves).show(3, ForceLimit::kCameraOnly);
  EXPECT_EQ(second.limit(), ForceLimit::kNothingMoves);
  second.show(2, ForceLimit::kCameraOnly);
  EXPECT_EQ(second.limit(), ForceLimit::kCameraOnly);
}

TEST(ForceLimitHistory, RepeatedFramesCountOnlyWhereThereIsNothingElse) {
  Second second;
  second.show(20, ForceLimit::kRepeatedFrames);
  EXPECT_EQ(second.limit(), ForceLimit::kRepeatedFrames);
  second.show(1, ForceLimit::kCameraOnly);
  EXPECT_EQ(second.limit(), ForceLimit::kCameraOnly) << "as a film with repeated frames has it";
}

TEST(ForceLimitHistory, ACutCountsOnlyIfNoOtherFrameHasAReason) {
  Second second;
  second.show(3, ForceLimit::kNothingToCompare);
  EXPECT_EQ(second.limit(), ForceLimit::kNothingToCompare);
  second.show(1, ForceLimit::kTooWeak, kFeltForce_N / 2);
  EXPECT_EQ(second.limit(), ForceLimit::kTooWeak);
}

TEST(ForceLimitHistory, LooksBackForASecond) {
  Second second;
  second.show(1, ForceLimit::kNone, kFeltForce_N).show(24, ForceLimit::kNothingMoves);
  EXPECT_EQ(second.limit(), ForceLimit::kNone) << "0.96 s ago";
  second.show(1, ForceLimit::kNothingMoves);
  EXPECT_EQ(second.limit(), ForceLimit::kNothingMoves) << "a second ago";
}

TEST(ForceLimitHistory, CountsShownFramesAndNotWaitingOnes) {
  Second second;
  second.show(5, ForceLimit::kNothingMoves).show(5, ForceLimit::kNone, 1);
  EXPECT_EQ(second.history.limit(4 * kFrame_ns), ForceLimit::kNothingMoves);
  EXPECT_EQ(second.history.limit(5 * kFrame_ns), ForceLimit::kNone);
}

TEST(ForceLimitHistory, ForgetsEarlierFramesWhenTheTimeFalls) {
  Second second;
  second.show(20, ForceLimit::kNone, 1);
  second.history.add(0, 0, ForceLimit::kNothingMoves);
  EXPECT_EQ(second.history.limit(kFrame_ns), ForceLimit::kNothingMoves);
}

TEST(ForceLimitHistory, KeepsTheLatestFramesWhenThereAreTooMany) {
  Second second;
  second.show(2 * static_cast<int>(ForceLimitHistory::kFrames), ForceLimit::kNothingMoves);
  EXPECT_EQ(second.limit(), ForceLimit::kNothingMoves);
}

}  // namespace
}  // namespace spidar::test::force_limit_test
