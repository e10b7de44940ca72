// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Reasons why there is no force, without an element: their texts, and which of them a frame and a
// second of frames have.
#include "core/analysis/motion_analyzer.h"
#include "core/force/motion_rendering.h"
#include "core/motion/camera/background.h"
#include "plugin/reasons/no_force.h"
#include "tests/support/test.h"

namespace spidar::test::no_force_watch_test {
namespace {

constexpr int64_t kFrame_ns = 40'000'000;

TEST(NoForceReason, EachHasANickOfItsOwnAndASentence) {
  std::set<std::string> nicks;
  for (size_t i = 0; i < kNoForceReasons; ++i) {
    const auto reason = static_cast<NoForceReason>(i);
    EXPECT_TRUE(nicks.insert(nick(reason)).second) << nick(reason);
    EXPECT_EQ(no_force_reason(nick(reason)), reason) << nick(reason);
    if (reason == NoForceReason::kNone) continue;
    EXPECT_EQ(sentence(reason)[std::strlen(sentence(reason)) - 1], '.') << nick(reason);
  }
  EXPECT_STREQ(sentence(NoForceReason::kNone), "");
  EXPECT_STREQ(nick(NoForceReason::kVibration), "vibration");
  EXPECT_STREQ(nick(NoForceReason::kSilentTrack), "silent-track");
  EXPECT_STREQ(nick(NoForceReason::kNoDevice), "no-device");
  EXPECT_EQ(nicks.count("unknown"), 0u);
}

TEST(NoForceReason, TorqueCountsByItsArm) {
  Wrench wrench;
  wrench.force_N = {3, 0, 0};
  wrench.torque_Nm = {0, 0, 4 * kTorqueArm_m};
  EXPECT_NEAR(size_N(wrench), 5, 1e-12);
}

/// A frame in which nothing is felt, with points enough.
Frame unfelt() {
  Frame frame;
  frame.picture = FrameComparison::kOther;
  frame.shown_height_px = 480;
  frame.interval_ns = kFrame_ns;
  frame.features = 100;
  return frame;
}

TEST(NoForceReason, OfARuleThatFeelsNothingIsTheRule) {
  FeelRule rule;
  rule.kind = FeelRule::Kind::kNothing;
  Frame frame = unfelt();
  frame.choice.rule = rule;
  EXPECT_EQ(reason_in_frame(frame, MotionKind::kObject), NoForceReason::kNotChosen);
  frame.choice.rule->kind = FeelRule::Kind::kObjectAt;
  EXPECT_EQ(reason_in_frame(frame, MotionKind::kObject), NoForceReason::kNotChosen) << "it is lost";
  frame.felt_object = 1;
  EXPECT_EQ(reason_in_frame(frame, MotionKind::kObject), NoForceReason::kNothingMoves)
      << "it rests";
}

TEST(NoForceReason, WhereTheFilmIsNotKnownIsThatOrThatThereIsNone) {
  Frame frame = unfelt();
  frame.place.is_known = false;
  EXPECT_EQ(reason_in_frame(frame, MotionKind::kObject), NoForceReason::kAreaUnknown);
  frame.place.is_page = true;
  EXPECT_EQ(reason_in_frame(frame, MotionKind::kObject), NoForceReason::kNoFilm);
}

TEST(NoForceReason, WhereNothingAgreesHowTheCameraMovesIsThat) {
  Background background;
  background.coverage = 0;
  background.is_known = false;
  Frame frame = unfelt();
  frame.background = background;
  EXPECT_EQ(reason_in_frame(frame, MotionKind::kObject), NoForceReason::kCameraUnknown);
  EXPECT_EQ(reason_in_frame(frame, MotionKind::kCamera), NoForceReason::kNothingMoves)
      << "nothing is left out";
  frame.background->is_known = true;
  EXPECT_EQ(reason_in_frame(frame, MotionKind::kObject), NoForceReason::kNothingMoves)
      << "too few votes for any model are those of a plain background at rest";
}

/// Frames of one reason, 40 ms apart.
class Second {
 public:
  Second& show(int count, NoForceReason reason, double force_N = 0) {
    for (int i = 0; i < count; ++i) history.add(kFrame_ns * frames_++, force_N, reason);
    return *this;
  }
  NoForceReason reason() const { return history.reason(kFrame_ns * (frames_ - 1)); }

  NoForceHistory history;

 private:
  int frames_ = 0;
};

TEST(NoForceHistory, KnowsNothingWithoutFrames) {
  EXPECT_EQ(NoForceHistory().reason(0), NoForceReason::kNoFrames);
}

TEST(NoForceHistory, TakesTheReasonThatMostPicturesHave) {
  Second second;
  second.show(4, NoForceReason::kNothingMoves).show(3, NoForceReason::kCameraOnly);
  EXPECT_EQ(second.reason(), NoForceReason::kNothingMoves);
  second.show(2, NoForceReason::kCameraOnly);
  EXPECT_EQ(second.reason(), NoForceReason::kCameraOnly);
}

TEST(NoForceHistory, RepeatedFramesCountOnlyWhereThereIsNothingElse) {
  Second second;
  second.show(20, NoForceReason::kRepeatedFrames);
  EXPECT_EQ(second.reason(), NoForceReason::kRepeatedFrames);
  second.show(1, NoForceReason::kCameraOnly);
  EXPECT_EQ(second.reason(), NoForceReason::kCameraOnly) << "as a film with repeated frames has it";
}

TEST(NoForceHistory, ACutCountsOnlyIfNoOtherFrameHasAReason) {
  Second second;
  second.show(3, NoForceReason::kNothingToCompare);
  EXPECT_EQ(second.reason(), NoForceReason::kNothingToCompare);
  second.show(1, NoForceReason::kTooWeak, kFeltForce_N / 2);
  EXPECT_EQ(second.reason(), NoForceReason::kTooWeak);
}

TEST(NoForceHistory, LooksBackForASecond) {
  Second second;
  second.show(1, NoForceReason::kNone, kFeltForce_N).show(24, NoForceReason::kNothingMoves);
  EXPECT_EQ(second.reason(), NoForceReason::kNone) << "0.96 s ago";
  second.show(1, NoForceReason::kNothingMoves);
  EXPECT_EQ(second.reason(), NoForceReason::kNothingMoves) << "a second ago";
}

TEST(NoForceHistory, CountsShownFramesAndNotWaitingOnes) {
  Second second;
  second.show(5, NoForceReason::kNothingMoves).show(5, NoForceReason::kNone, 1);
  EXPECT_EQ(second.history.reason(4 * kFrame_ns), NoForceReason::kNothingMoves);
  EXPECT_EQ(second.history.reason(5 * kFrame_ns), NoForceReason::kNone);
}

TEST(NoForceHistory, ForgetsEarlierFramesWhenTheTimeFalls) {
  Second second;
  second.show(20, NoForceReason::kNone, 1);
  second.history.add(0, 0, NoForceReason::kNothingMoves);
  EXPECT_EQ(second.history.reason(kFrame_ns), NoForceReason::kNothingMoves);
}

TEST(NoForceHistory, KeepsTheLatestFramesWhenThereAreTooMany) {
  Second second;
  second.show(2 * static_cast<int>(NoForceHistory::kFrames), NoForceReason::kNothingMoves);
  EXPECT_EQ(second.reason(), NoForceReason::kNothingMoves);
}

}  // namespace
}  // namespace spidar::test::no_force_watch_test
