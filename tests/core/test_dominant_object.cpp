#include <vector>

#include <gtest/gtest.h>

#include "core/motion/dominant_object.h"

namespace spidar {
namespace {

constexpr double kFrame_s = 0.04;
/// Frames in which another object must be more prominent.
constexpr int kFrames = static_cast<int>(DominantObject::kTakesOver_s / kFrame_s) + 1;

MovingObject object(uint32_t id, double prominence) {
  MovingObject made;
  made.id = id;
  made.prominence = prominence;
  return made;
}

TEST(DominantObject, IsTheMostProminentOneToBeginWith) {
  DominantObject dominant;
  EXPECT_EQ(dominant.choose({}, kFrame_s), nullptr);
  EXPECT_EQ(dominant.choose({object(1, 5), object(2, 9), object(3, 7)}, kFrame_s)->id, 2u);
}

TEST(DominantObject, StaysWhenAnotherIsALittleMoreProminent) {
  DominantObject dominant;
  dominant.choose({object(1, 10), object(2, 9)}, kFrame_s);
  for (int n = 0; n < 10 * kFrames; ++n) {
    ASSERT_EQ(dominant.choose({object(1, 10), object(2, 14)}, kFrame_s)->id, 1u) << n;
  }
}

TEST(DominantObject, GoesToOneThatIsClearlyMoreProminentForLong) {
  DominantObject dominant;
  dominant.choose({object(1, 10)}, kFrame_s);
  const std::vector<MovingObject> outshone{object(1, 10), object(2, 16)};
  for (int n = 1; n < kFrames; ++n) ASSERT_EQ(dominant.choose(outshone, kFrame_s)->id, 1u) << n;
  EXPECT_EQ(dominant.choose(outshone, kFrame_s)->id, 2u);
}

TEST(DominantObject, AMomentIsNotLong) {
  DominantObject dominant;
  dominant.choose({object(1, 10)}, kFrame_s);
  for (int n = 0; n < 10 * kFrames; ++n) {
    const double other = n % kFrames == 0 ? 10 : 30;
    ASSERT_EQ(dominant.choose({object(1, 10), object(2, other)}, kFrame_s)->id, 1u) << n;
  }
}

TEST(DominantObject, LeavesOneThatHasDied) {
  DominantObject dominant;
  dominant.choose({object(1, 10), object(2, 1)}, kFrame_s);
  EXPECT_EQ(dominant.choose({object(2, 1)}, kFrame_s)->id, 2u);
  EXPECT_EQ(dominant.choose({}, kFrame_s), nullptr);
}

}  // namespace
}  // namespace spidar
