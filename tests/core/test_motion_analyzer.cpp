// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_analyzer.h"
#include "tests/core/moving_texture.h"
#include "tests/support/test.h"

namespace spidar::test::motion_analyzer_test {
namespace {

constexpr int64_t kFrame_ns = 40'000'000;
constexpr double kFrame_s = 0.04;

AnalyzerSettings linear() {
  AnalyzerSettings settings = paper_settings();
  settings.controller.law = ControlLaw::kLinear;
  return settings;
}

void expect_nothing(const Frame& analysis) {
  EXPECT_EQ(analysis.motion.velocity_px_s, Eigen::Vector2d::Zero());
  EXPECT_EQ(analysis.motion.tracked, 0);
  EXPECT_EQ(analysis.wrench.stacked(), (Eigen::Matrix<double, 6, 1>::Zero()));
}

void expect_restarted(const Frame& analysis) {
  EXPECT_FALSE(analysis.has_motion_before());
  EXPECT_EQ(analysis.interval_ns, 0);
  expect_nothing(analysis);
}

TEST(MotionAnalyzer, ARunningTimeThatDoesNotRiseRestarts) {
  MovingTexture scene(640, 360, 3, 0);
  for (const int64_t step_ns : {int64_t{0}, -kFrame_ns, -10'000 * kFrame_ns}) {
    MotionAnalyzer analyzer(linear());
    analyzer.analyze(scene.frame(0), 0);
    analyzer.analyze(scene.frame(1), kFrame_ns);
    expect_restarted(analyzer.analyze(scene.frame(2), kFrame_ns + step_ns));
    // Continues from there.
    const Frame next = analyzer.analyze(scene.frame(3), 2 * kFrame_ns + step_ns);
    EXPECT_TRUE(next.has_motion_before());
    EXPECT_EQ(next.interval_ns, kFrame_ns);
    EXPECT_GT(next.motion.velocity_px_s.x(), 0);
  }
}

TEST(MotionAnalyzer, RestartForgetsTheFrameAndTheLargestSpeed) {
  MovingTexture fast(640, 360, 8, 0);
  MovingTexture slow(640, 360, 1, 0);
  MotionAnalyzer analyzer(linear());
  analyzer.analyze(fast.frame(0), 0);
  // Rounding only: the first speed is the largest, so the force is the maximum.
  EXPECT_NEAR(analyzer.analyze(fast.frame(1), kFrame_ns).wrench.force_N.norm(), 3.0, 1e-14);
  analyzer.reset();
  expect_restarted(analyzer.analyze(slow.frame(0), 2 * kFrame_ns));
  EXPECT_NEAR(analyzer.analyze(slow.frame(1), 3 * kFrame_ns).wrench.force_N.norm(), 3.0, 1e-14);
}

TEST(MotionAnalyzer, ACutShowsNoMotionAndKeepsTheLargestSpeed) {
  // Vmax(T) of eq. 13 is the largest since the video began, whatever its scenes.
  MovingTexture fast(640, 360, 8, 0, 8);
  MovingTexture slow(640, 360, 2, 0, 77);
  MotionAnalyzer analyzer(linear());
  analyzer.analyze(fast.frame(0), 0);
  const double fastest_px_s =
      analyzer.analyze(fast.frame(1), kFrame_ns).motion.velocity_px_s.norm();
  expect_restarted(analyzer.analyze(slow.frame(2), 2 * kFrame_ns));
  const Frame after = analyzer.analyze(slow.frame(3), 3 * kFrame_ns);
  EXPECT_TRUE(after.has_motion_before());
  EXPECT_NEAR(after.wrench.force_N.norm(), 3.0 * after.motion.velocity_px_s.norm() / fastest_px_s,
              1e-14);
}

TEST(MotionAnalyzer, TheFilterBeginsAnewAfterACut) {
  AnalyzerSettings settings = paper_settings();
  settings.filter = FilterSettings();
  MotionAnalyzer analyzer(settings);
  MotionAnalyzer unfiltered(paper_settings());
  int64_t time_ns = 0;
  for (const uint32_t seed : {8u, 77u}) {
    MovingTexture scene(640, 360, seed == 8 ? 6 : -6, 2, seed);
    for (int n = 0; n < 4; ++n) {
      time_ns += kFrame_ns * (1 + n % 2);  // uneven intervals, for velocities that differ
      const Frame frame = analyzer.analyze(scene.frame(n), time_ns);
      const Frame plain = unfiltered.analyze(scene.frame(n), time_ns);
      EXPECT_EQ(frame.motion.velocity_px_s, plain.motion.velocity_px_s) << "what is reported";
      const double difference_N = (frame.wrench.force_N - plain.wrench.force_N).norm();
      // The first motion passes: rounding of a factor and its inverse. Later ones are filtered:
      // half the speed or twice of it is not reached at once.
      if (n < 2) {
        EXPECT_LT(difference_N, 1e-14) << n;
      } else {
        EXPECT_GT(difference_N, 1e-3) << n;
      }
    }
  }
}

TEST(MotionAnalyzer, NewLimitsKeepWhatTheControllerHasLearnt) {
  MovingTexture scene(640, 360, 4, 0);
  AnalyzerSettings settings = linear();
  MotionAnalyzer analyzer(settings);
  analyzer.analyze(scene.frame(0), 0);
  analyzer.analyze(scene.frame(1), kFrame_ns);
  // Half the speed over twice the time.
  settings.controller.max_force_N = 1.0;
  analyzer.configure(settings);
  const Frame half = analyzer.analyze(scene.frame(2), 3 * kFrame_ns);
  // Two speeds, each of 100 px/s with the tolerance of a mean.
  const double relative = 2 * kMeanTolerance_px / kFrame_s / 100;
  EXPECT_NEAR(half.wrench.force_N.norm(), 0.5, 0.5 * relative);

  // Another kind starts anew.
  settings.controller.law = ControlLaw::kNonlinear;
  analyzer.configure(settings);
  const Frame nonlinear = analyzer.analyze(scene.frame(3), 4 * kFrame_ns);
  GainController controller({ControlLaw::kNonlinear, 1.0, 0.0025});
  EXPECT_EQ(nonlinear.wrench.stacked(),
            render_motion(controller, nonlinear.motion, {}, 360).stacked());
}

TEST(MotionAnalyzer, BadSettingsAreRefusedByName) {
  using Settings = AnalyzerSettings;
  using Number = double& (*)(Settings&);
  const std::pair<const char*, Number> numbers[] = {
      {"max_force_N", [](Settings& s) -> double& { return s.controller.max_force_N; }},
      {"alpha_s_px", [](Settings& s) -> double& { return s.controller.alpha_s_px; }},
      {"min_cutoff_Hz", [](Settings& s) -> double& { return s.filter.min_cutoff_Hz; }},
      {"beta_s_px", [](Settings& s) -> double& { return s.filter.beta_s_px; }},
      {"depth gain", [](Settings& s) -> double& { return s.axes.depth; }},
      {"roll gain", [](Settings& s) -> double& { return s.axes.roll; }},
      {"washout_Hz", [](Settings& s) -> double& { return s.washout_Hz; }},
      {"quality_level", [](Settings& s) -> double& { return s.tracker.quality_level; }},
      {"min_distance_px", [](Settings& s) -> double& { return s.tracker.min_distance_px; }},
      {"pointer", [](Settings& s) -> double& { return s.pointer.x(); }},
      {"click", [](Settings& s) -> double& { return s.kept.position.y(); }}};
  for (const auto& [name, number] : numbers) {
    for (const double bad : {-HUGE_VAL, HUGE_VAL, std::nan("")}) {
      Settings settings;
      number(settings) = bad;
      try {
        const MotionAnalyzer analyzer(settings);
        ADD_FAILURE() << name << " " << bad;
      } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      }
    }
  }
}

TEST(MotionAnalyzer, BadSettingsAreRefusedAndChangeNothing) {
  MovingTexture scene(640, 360, 4, 0);
  MotionAnalyzer analyzer(paper_settings());
  analyzer.analyze(scene.frame(0), 0);
  AnalyzerSettings bad;
  bad.tracker.min_distance_px = 1e3;
  bad.controller.max_force_N = -1;
  EXPECT_THROW(analyzer.configure(bad), std::invalid_argument);
  EXPECT_THROW(MotionAnalyzer{bad}, std::invalid_argument);
  EXPECT_GT(analyzer.analyze(scene.frame(1), kFrame_ns).features, 50);
}

}  // namespace
}  // namespace spidar::test::motion_analyzer_test
