// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The analysis of a frame as JSON, read back by an independent parser.
#include <nlohmann/json.hpp>

#include "core/analysis/motion_analyzer.h"
#include "plugin/filter/reports/frame_trace.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::frame_trace_test {
namespace {

using filter::json_line;
using nlohmann::json;

json parsed(const Frame& frame, const FrameStamp& stamp = {}) {
  FrameReport report;
  report.stamp = stamp;
  report.frame = frame;
  const std::string line = json_line(report);
  EXPECT_EQ(line.find('\n'), line.size() - 1) << line;
  return json::parse(line);
}

void expect_vector(const json& found, const Eigen::Vector2d& expected) {
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].get<double>(), expected.x());
  EXPECT_EQ(found[1].get<double>(), expected.y());
}

TEST(FrameTrace, HasEverythingThatWasFoundToTheLastBit) {
  MovingScene scene(320, 180);
  scene.add_disc(40);
  AnalyzerSettings settings;
  settings.motion = MotionKind::kObject;
  MotionAnalyzer analyzer(settings);
  Frame frame;
  for (int n = 0; n < 6; ++n) {
    const Placement camera{{2.0 * n, 1.0 * n}, 1 + 0.01 * n};
    frame = analyzer.analyze(scene.draw(camera, {{{-60.0 + 9 * n, 10}}}), 40'000'000 * n);
  }
  const json j = parsed(frame, {1, 0, 200'000'000});
  EXPECT_EQ(j["running_time_ns"], 200'000'000);
  EXPECT_EQ(j["stream_time_ns"], 0);
  EXPECT_EQ(j["interval_ns"], 40'000'000);
  EXPECT_EQ(j["width_px"], 320);
  EXPECT_EQ(j["height_px"], 180);
  EXPECT_EQ(j["restarted"], false);
  EXPECT_EQ(j["repeated"], false);
  EXPECT_EQ(j["features"], frame.features);
  expect_vector(j["motion"]["velocity_px_s"], frame.motion.velocity_px_s);
  EXPECT_EQ(j["motion"]["tracked"], frame.motion.tracked);
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<size_t>(i);
    EXPECT_EQ(j["wrench"]["force_N"][k].get<double>(), frame.wrench.force_N[i]);
    EXPECT_EQ(j["wrench"]["torque_Nm"][k].get<double>(), frame.wrench.torque_Nm[i]);
  }

  ASSERT_TRUE(frame.background);
  const MotionModel& model = frame.background->model;
  ASSERT_GE(model.kind, ModelKind::kSimilarity);
  EXPECT_EQ(j["background"]["model"], to_string(model.kind));
  expect_vector(j["background"]["shift_px"], model.shift_px);
  for (int i = 0; i < 2; ++i) {
    expect_vector(j["background"]["linear"][static_cast<size_t>(i)], model.linear.row(i));
  }
  EXPECT_EQ(j["background"]["coverage"].get<double>(), frame.background->coverage);

  ASSERT_EQ(frame.objects.size(), 1u);
  ASSERT_EQ(j["objects"].size(), 1u);
  const MovingObject& object = frame.objects.front();
  EXPECT_EQ(j["objects"][0]["id"], object.id);
  expect_vector(j["objects"][0]["position_px"], object.position_px);
  expect_vector(j["objects"][0]["velocity_px_s"], object.relative_px_s);
  EXPECT_EQ(j["objects"][0]["error_px_s"].get<double>(), object.error_px_s);
  EXPECT_GT(object.error_px_s, 0);
  expect_vector(j["objects"][0]["on_screen_px_s"], object.on_screen_px_s);
  EXPECT_EQ(j["objects"][0]["points"], object.points);
}

TEST(FrameTrace, WhatIsNotKnownIsNullOrEmpty) {
  Frame frame;
  const json j = parsed(frame);
  EXPECT_EQ(j["restarted"], true);
  EXPECT_TRUE(j["background"].is_null());
  EXPECT_EQ(j["objects"], json::array());
}

TEST(FrameTrace, NumbersThatJsonDoesNotHaveAreNull) {
  Frame frame;
  frame.motion.velocity_px_s = {std::nan(""), -std::numeric_limits<double>::infinity()};
  frame.motion.growth_1_s = 1e-300;
  frame.motion.roll_rad_s = -0.1;
  const json j = parsed(frame);
  EXPECT_TRUE(j["motion"]["velocity_px_s"][0].is_null());
  EXPECT_TRUE(j["motion"]["velocity_px_s"][1].is_null());
  EXPECT_EQ(j["motion"]["growth_1_s"].get<double>(), 1e-300);
  EXPECT_EQ(j["motion"]["roll_rad_s"].get<double>(), -0.1);
}

}  // namespace
}  // namespace spidar::test::frame_trace_test
