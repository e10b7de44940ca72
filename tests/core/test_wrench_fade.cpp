// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/force_renderer.h"
#include "core/wrench.h"
#include "tests/support/test.h"

namespace spidar::test::wrench_fade_test {
namespace {

/// A few operations on numbers near 1.
constexpr double kRounding = 1e-14;

Wrench pushing(double x_N, double turning_Nm = 0) {
  Wrench wrench;
  wrench.force_N.x() = x_N;
  wrench.torque_Nm.z() = turning_Nm;
  return wrench;
}

constexpr double kFrame_s = 0.04;  // 0.4 of kFade_s

Wrench felt(WrenchFade& fade, const Wrench& wrench, uint32_t object, double interval_s) {
  fade.set_object(object);
  return fade.fade(wrench, interval_s);
}

TEST(WrenchFade, AnObjectThatBeginsIsFeltAtOnce) {
  WrenchFade fade;
  felt(fade, {}, 0, kFrame_s);
  EXPECT_EQ(felt(fade, pushing(2), 1, kFrame_s).force_N.x(), 2);
  // However fast it changes.
  EXPECT_EQ(felt(fade, pushing(-2), 1, kFrame_s).force_N.x(), -2);
  EXPECT_EQ(felt(fade, {}, 1, kFrame_s).force_N.x(), 0);
  for (int n = 0; n < 3; ++n) felt(fade, {}, 0, kFrame_s);
  EXPECT_EQ(felt(fade, pushing(2), 2, kFrame_s).force_N.x(), 2);
  fade.reset();
  EXPECT_EQ(felt(fade, pushing(-1), 3, kFrame_s).force_N.x(), -1);
}

TEST(WrenchFade, GoesFromOneObjectToAnother) {
  WrenchFade fade;
  felt(fade, pushing(2, 0.02), 1, kFrame_s);
  const Wrench first = felt(fade, pushing(-1), 2, kFrame_s);
  EXPECT_NEAR(first.force_N.x(), 0.6 * 2 - 0.4 * 1, kRounding);
  EXPECT_NEAR(first.torque_Nm.z(), 0.6 * 0.02, kRounding);
  EXPECT_NEAR(felt(fade, pushing(-2), 2, kFrame_s).force_N.x(), 0.2 * 2 - 0.8 * 2, kRounding);
  EXPECT_EQ(felt(fade, pushing(-2), 2, kFrame_s).stacked(), pushing(-2).stacked());
  // Back before it is over: from what is felt.
  felt(fade, pushing(2), 1, kFrame_s);
  EXPECT_NEAR(felt(fade, pushing(-2), 2, kFrame_s).force_N.x(), 0.6 * -0.4 - 0.4 * 2, kRounding);
}

TEST(WrenchFade, AnObjectThatIsLostFadesInTheSameTimeAtEveryFrameRate) {
  for (const int frames : {1, 2, 5, 10}) {
    const double interval_s = WrenchFade::kFade_s / frames;
    WrenchFade fade;
    double before_N = felt(fade, pushing(2), 1, interval_s).force_N.x();
    for (int n = 0; n < frames; ++n) {
      const double now_N = felt(fade, {}, 0, interval_s).force_N.x();
      EXPECT_NEAR(before_N - now_N, 2.0 / frames, 2 * frames * kRounding);
      before_N = now_N;
    }
    EXPECT_EQ(felt(fade, {}, 0, interval_s).force_N.x(), 0);
  }
}

}  // namespace
}  // namespace spidar::test::wrench_fade_test
