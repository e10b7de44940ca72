// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_analyzer.h"
#include "core/force/washout.h"
#include "tests/core/timeline_frames.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::washout_test {
namespace {

constexpr double kMost_N = 3;
/// A frame takes a handful of operations on numbers below 6, each rounded by 2^-53 of that, and
/// what a frame has wrong fades.
constexpr double kRounding_N = 1e-13;
const double kTwoPi = 2 * M_PI;

Wrench pushed(double x_N) {
  return {{x_N, 0, 0}, {0, 0, 0}};
}

TEST(Washout, AStepDecaysWithItsTimeConstantAtAnyFrameRate) {
  for (const double cutoff_Hz : {0.1, 0.3, 1.0}) {
    for (const double frame_s : {1 / 24.0, 1 / 60.0, 0.17}) {
      Washout washout;
      for (int n = 0; n < 200; ++n) {
        const Wrench passed =
            washout.apply({{2, -1, 0}, {0, 0, 0.01}}, frame_s, cutoff_Hz, kMost_N);
        const double left = std::exp(-kTwoPi * cutoff_Hz * frame_s * n);
        ASSERT_NEAR(passed.force_N.x(), 2 * left, kRounding_N) << n;
        ASSERT_NEAR(passed.force_N.y(), -left, kRounding_N) << n;
        ASSERT_NEAR(passed.torque_Nm.z(), 0.01 * left, kRounding_N) << n;
      }
      // What was lost comes back in the opposite direction.
      const double lost = 1 - std::exp(-kTwoPi * cutoff_Hz * frame_s * 200);
      EXPECT_NEAR(washout.apply({}, frame_s, cutoff_Hz, kMost_N).force_N.x(), -2 * lost,
                  kRounding_N);
    }
  }
}

TEST(Washout, AForceThatTurnsRoundStaysWithinTheLargest) {
  constexpr double kFrame_s = 0.04;
  Washout washout;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> size(-1.7, 1.7), cutoff(0.1, 1);
  for (int n = 0; n < 5000; ++n) {
    const double sign = n / 50 % 2 == 0 ? 1 : -1;
    const Wrench in{{1.7 * sign, size(random), size(random)}, {0, 0, 0.01 * sign}};
    const Wrench out = washout.apply(in, kFrame_s, cutoff(random), kMost_N);
    ASSERT_LE(size_N(out), kMost_N * (1 + 1e-12)) << "seed 1, step " << n;
  }
}

TEST(Washout, OffChangesNoBitAndForgets) {
  Washout washout;
  for (int n = 0; n < 10; ++n) {
    EXPECT_TRUE(same_bits(washout.apply(wrench_of(n), 0.04, 0, 0.001), wrench_of(n)));
  }
  washout.apply(pushed(2), 0.04, 0.5, kMost_N);
  washout.apply(pushed(2), 0.04, 0, kMost_N);
  EXPECT_EQ(washout.apply(pushed(2), 0.04, 0.5, kMost_N).force_N.x(), 2);
}

/// Forces to the right of a disc that moves to the right, twice, with a seek in between.
std::vector<double> forces_N(double washout_Hz) {
  AnalyzerSettings settings;
  settings.washout_Hz = washout_Hz;
  MotionAnalyzer analyzer(settings);
  std::vector<double> forces;
  for (int run = 0; run < 2; ++run) {
    analyzer.reset();
    MovingScene scene(320, 240);
    scene.add_disc(40);
    for (int n = 0; n < 25; ++n) {
      const ImageView picture = scene.draw({}, {{{4.0 * n - 50, 0}}});
      const auto shown = static_cast<int64_t>(forces.size());
      forces.push_back(analyzer.analyze(picture, 40'000'000 * shown).wrench.force_N.x());
    }
  }
  return forces;
}

TEST(Washout, IsThatOfTheAnalysisAndBeginsAnewAfterASeek) {
  constexpr double kCutoff_Hz = 0.5, kFrame_s = 0.04;
  const std::vector<double> plain = forces_N(0), faded = forces_N(kCutoff_Hz);
  Washout washout;
  bool begun = false;
  for (size_t n = 0; n < plain.size(); ++n) {
    if (plain[n] == 0) washout.reset();  // before anything is felt, and after the seek
    begun = begun || plain[n] != 0;
    const double expected =
        plain[n] == 0 ? 0
                      : washout.apply(pushed(plain[n]), kFrame_s, kCutoff_Hz, kMost_N).force_N.x();
    ASSERT_NEAR(faded[n], expected, 1e-6) << n;
  }
  EXPECT_TRUE(begun);
  EXPECT_GT(plain[24], 0.3);
  EXPECT_LT(faded[24], 0.2 * plain[24]);
  EXPECT_GT(plain[49], 0.3);
}

}  // namespace
}  // namespace spidar::test::washout_test
