// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/dominant_object.h"

namespace spidar {
namespace {

MovingObject object(uint32_t id, double prominence) {
  MovingObject made;
  made.id = id;
  made.prominence = prominence;
  return made;
}

TEST(DominantObject, IsTheMostProminentOneToBeginWith) {
  DominantObject dominant;
  EXPECT_EQ(dominant.choose({}), nullptr);
  EXPECT_EQ(dominant.choose({object(1, 5), object(2, 9), object(3, 7)})->id, 2u);
}

TEST(DominantObject, StaysWhenAnotherIsALittleMoreProminent) {
  DominantObject dominant;
  dominant.choose({object(1, 10), object(2, 9)});
  for (int n = 0; n < 100; ++n) {
    ASSERT_EQ(dominant.choose({object(1, 10), object(2, 19)})->id, 1u) << n;
  }
}

TEST(DominantObject, GoesAtOnceToOneThatIsClearlyMoreProminent) {
  DominantObject dominant;
  dominant.choose({object(1, 10)});
  EXPECT_EQ(dominant.choose({object(1, 10), object(2, 21)})->id, 2u);
  // And does not come back for less.
  EXPECT_EQ(dominant.choose({object(1, 41), object(2, 21)})->id, 2u);
}

TEST(DominantObject, LeavesOneThatHasDied) {
  DominantObject dominant;
  dominant.choose({object(1, 10), object(2, 1)});
  EXPECT_EQ(dominant.choose({object(2, 1)})->id, 2u);
  EXPECT_EQ(dominant.choose({}), nullptr);
}

}  // namespace
}  // namespace spidar
