// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Scenes with depth, and patterns that repeat, in which only the camera moves.
#include "core/analysis/motion_analyzer.h"
#include "tests/support/depth_clip.h"
#include "tests/support/depth_clip_score.h"
#include "tests/support/test.h"

namespace spidar::test::depth_clips_test {
namespace {

TEST(DepthClips, NothingIsFeltWhileOnlyTheCameraMoves) {
  for (int kind = 0; kind < DepthClip::kKinds; ++kind) {
    const auto each = static_cast<DepthClip::Kind>(kind);
    EXPECT_EQ(score(each, 1).felt, 0) << DepthClip::to_string(each);
  }
}

// Were they still films, nothing would be felt either.
TEST(DepthClips, TheCameraMoves) {
  for (int kind = 0; kind < DepthClip::kKinds; ++kind) {
    const auto each = static_cast<DepthClip::Kind>(kind);
    const DepthClip clip(each, static_cast<uint32_t>(1 + 100 * kind));
    MotionAnalyzer analyzer;
    for (int n = 0; n < 2; ++n) {
      const Picture picture = clip.picture(n);
      const Frame& frame = analyzer.analyze(picture.view(), n * 40'000'000);
      if (n == 0) continue;
      ASSERT_TRUE(frame.background);
      EXPECT_NE(frame.background->model.kind, ModelKind::kStill) << DepthClip::to_string(each);
    }
  }
}

}  // namespace
}  // namespace spidar::test::depth_clips_test
