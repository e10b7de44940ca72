// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <tuple>

#include "core/motion/objects/dominant_object.h"
#include "tests/support/test.h"

namespace spidar::test::dominant_object_test {
namespace {

constexpr double kFrame_s = DominantObject::kReason_s / 5;
constexpr int kLong = 100;  // frames
/// What the followed object, of prominence 10, is compared with.
constexpr double kClaim = 10 * DominantObject::kClearly;

MovingObject object(uint32_t id, double prominence) {
  MovingObject made;
  made.id = id;
  made.prominence = prominence;
  made.points = 4;
  return made;
}

MovingObject out_of_sight(uint32_t id) {
  MovingObject made = object(id, 0);
  made.points = 0;
  return made;
}

/// The id of the object that is chosen, 0 for none, after `frames` frames with `objects`.
uint32_t choice(DominantObject& dominant, const std::vector<MovingObject>& objects, int frames = 1,
                double interval_s = kFrame_s) {
  const MovingObject* chosen = nullptr;
  for (int n = 0; n < frames; ++n) chosen = dominant.choose(objects, interval_s);
  return chosen ? chosen->id : 0;
}

/// Follows object 1, of prominence 10, for long enough to leave it for something clearly more
/// prominent only.
void settle(DominantObject& dominant, double interval_s = kFrame_s) {
  const int frames = static_cast<int>(DominantObject::kSettles_s / interval_s) + 2;
  EXPECT_EQ(choice(dominant, {object(1, 10)}, frames, interval_s), 1u);
}

TEST(DominantObject, IsTheMostProminentOneToBeginWith) {
  DominantObject dominant;
  EXPECT_EQ(choice(dominant, {}, kLong), 0u);
  EXPECT_EQ(choice(dominant, {object(1, 5), object(2, 9), object(3, 7)}), 2u);
}

TEST(DominantObject, StaysWhenAnotherIsALittleMoreProminent) {
  // Also at two frames a second, where a single one is longer than kReason_s.
  for (const double interval_s : {kFrame_s, 0.5}) {
    DominantObject dominant;
    settle(dominant, interval_s);
    for (int n = 0; n < kLong; ++n) {
      ASSERT_EQ(choice(dominant, {object(1, 10), object(2, kClaim - 1)}, 1, interval_s), 1u) << n;
    }
  }
}

TEST(DominantObject, IsTheMoreProminentOneSoonWhicheverIsFoundFirst) {
  // Less than a settled one is left for. The rate (3.5 − c) / (3.5 + c) is positive until c is 3.5,
  // and the reason rises to (7 ln (7 / 4.5) − 2.5) / 3 = 0.197 · kSettles_s.
  const double prominence = 3.5 * 10;
  static_assert(0.197 * DominantObject::kSettles_s > DominantObject::kReason_s);
  DominantObject dominant;
  choice(dominant, {object(1, 10)});
  EXPECT_EQ(choice(dominant, {object(1, 10), object(2, prominence)}, kLong), 2u);
  dominant.reset();
  choice(dominant, {object(2, prominence)});
  EXPECT_EQ(choice(dominant, {object(1, 10), object(2, prominence)}, kLong), 2u);
  dominant.reset();
  settle(dominant);
  EXPECT_EQ(choice(dominant, {object(1, 10), object(2, prominence)}, kLong), 1u);
}

TEST(DominantObject, StaysWhenAnotherStandsOutInAFewFramesOnly) {
  DominantObject dominant;
  settle(dominant);
  // The reason rises by a quarter of a frame in each frame, and falls by half of one: by 17/4 and
  // 18/4 frames. Five are kReason_s.
  for (int n = 0; n < kLong; ++n) {
    ASSERT_EQ(choice(dominant, {object(1, 10), object(2, kClaim * 5 / 3)}, 17), 1u) << n;
    ASSERT_EQ(choice(dominant, {object(1, 10), object(2, kClaim / 3)}, 9), 1u) << n;
  }
}

/// Seconds until object 2 of `objects` takes over.
double time_to_leave(DominantObject& dominant, const std::vector<MovingObject>& objects,
                     double interval_s = kFrame_s) {
  int frames = 1;
  while (choice(dominant, objects, 1, interval_s) != 2 && frames < 2 * kLong) ++frames;
  return frames * interval_s;
}

TEST(DominantObject, GoesToAnotherTheSoonerTheMoreItStandsOut) {
  // At any frame rate after 3, 2 and 1.5 kReason_s. Half a frame of reason are up to 1.5 frames of
  // time.
  for (const double ratio : {2.0, 3.0, 5.0}) {
    const double prominence = ratio * kClaim;
    const double after_s = DominantObject::kReason_s * (ratio + 1) / (ratio - 1);
    for (const double interval_s : {0.01, 0.02, 0.04}) {
      DominantObject dominant;
      settle(dominant, interval_s);
      const std::vector<MovingObject> outshone = {object(1, 10), object(2, prominence)};
      EXPECT_NEAR(time_to_leave(dominant, outshone, interval_s), after_s, 1.6 * interval_s);
      // And does not come back for less than kClearly times as much.
      const double less = (DominantObject::kClearly - 0.1) * prominence;
      const std::vector<MovingObject> again = {object(1, less), object(2, prominence)};
      EXPECT_EQ(choice(dominant, {object(1, 1), object(2, prominence)}, 3 * kLong, interval_s), 2u);
      EXPECT_EQ(choice(dominant, again, kLong, interval_s), 2u);
    }
  }
}

TEST(DominantObject, MayRestForLongerWhenItHasStoodOutForLong) {
  const std::vector<MovingObject> at_rest = {object(1, 0), object(2, 5)};
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 5)});
  EXPECT_NEAR(time_to_leave(dominant, at_rest), DominantObject::kReason_s, kFrame_s / 2);
  dominant.reset();
  choice(dominant, {object(1, 10), object(2, 5)}, kLong);
  EXPECT_NEAR(time_to_leave(dominant, at_rest), 2 * DominantObject::kReason_s, kFrame_s / 2);
}

TEST(DominantObject, StaysWithOneThatIsMissingInAFewFrames) {
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 9)});
  // Out of sight, and taken for a layer of the scene.
  for (const auto& without : {std::vector<MovingObject>{out_of_sight(1), object(2, 9)},
                              std::vector<MovingObject>{object(2, 9)}}) {
    EXPECT_NE(choice(dominant, without, 4), 2u);
    EXPECT_EQ(choice(dominant, {object(1, 10), object(2, 9)}, kLong), 1u);
  }
}

TEST(DominantObject, LeavesOneThatIsGone) {
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 9)}, kLong);
  // Five frames are kReason_s.
  EXPECT_EQ(choice(dominant, {object(2, 9)}, 4), 0u);
  EXPECT_EQ(choice(dominant, {object(2, 9)}), 2u);
  EXPECT_EQ(choice(dominant, {}, kLong), 0u);
}

TEST(DominantObject, DoesNotWaitForOneThatHasLeftThePicture) {
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 9)}, kLong);
  MovingObject gone = out_of_sight(1);
  gone.has_left = true;
  EXPECT_EQ(choice(dominant, {gone, object(2, 9)}), 2u);
}

TEST(DominantObject, GoesOnAtOnceWithWhatIsAtThePlaceOfALostOne) {
  MovingObject lost = out_of_sight(1);
  lost.size_px << 40, 40;
  MovingObject there = object(2, 9);
  there.size_px << 20, 20;
  // All of it is inside the lost one, then less than half of it.
  for (const auto& [x_px, expected] : {std::pair(10.0, 2u), std::pair(21.0, 1u)}) {
    DominantObject dominant;
    choice(dominant, {object(1, 10)}, kLong);
    there.position_px.x() = x_px;
    EXPECT_EQ(choice(dominant, {lost, there}), expected) << x_px;
  }
}

TEST(DominantObject, GoesOnAtOnceWithWhatAppearsWhereALostOneMayHaveTurnedTo) {
  // A ball that falls by 18 px a frame bounces where it is not seen: it is expected below.
  MovingObject ball = object(1, 10);
  ball.size_px << 40, 40;
  ball.on_screen_px_s.y() = 18 / kFrame_s;
  MovingObject lost = out_of_sight(1);
  lost.size_px = ball.size_px;
  lost.position_px.y() = 2 * 18;
  MovingObject above = object(3, 9);
  above.size_px = ball.size_px;
  // In a frame it gets 18 px from where it was; each is 40 px high.
  for (const auto& [y_px, known, expected] :
       {std::tuple(-57, false, 3u), {-59, false, 1u}, {-57, true, 1u}}) {
    DominantObject dominant;
    above.position_px.y() = y_px;
    MovingObject before = above;
    before.id = known ? above.id : 2;
    choice(dominant, {ball, before}, kLong);
    EXPECT_EQ(choice(dominant, {lost, above}), expected) << y_px << (known ? ", known" : "");
  }
}

TEST(DominantObject, DoesNotGoToOneThatRests) {
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 9)});
  EXPECT_EQ(choice(dominant, {object(2, 0)}, kLong), 0u);
}

TEST(DominantObject, OneThatAppearsAfterALossIsFollowedTheSoonerTheLongerAgoThatWas) {
  // Half of the frames without any object count, of five.
  for (const auto& [without, with] : {std::pair(1, 5), std::pair(6, 2), std::pair(8, 1)}) {
    DominantObject dominant;
    EXPECT_EQ(choice(dominant, {object(1, 10)}), 1u);
    EXPECT_EQ(choice(dominant, {}, without), 0u);
    int frames = 1;
    while (choice(dominant, {object(2, 1)}) == 0 && frames < kLong) ++frames;
    EXPECT_EQ(frames, with) << without;
  }
}

TEST(DominantObject, AfterACutTheFirstOneIsFollowedAtOnce) {
  DominantObject dominant;
  EXPECT_EQ(choice(dominant, {object(1, 10)}), 1u);
  dominant.reset();
  EXPECT_EQ(choice(dominant, {object(2, 1)}), 2u);
}

}  // namespace
}  // namespace spidar::test::dominant_object_test
