// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The contents of a debug window, read back from the frame buffer.
#include <GLFW/glfw3.h>

#include "tests/support/test.h"
#include "tests/window/fake_source.h"
#include "tests/window/window_fixture.h"

namespace spidar::test::window_picture_test {
namespace {

TEST_F(WindowTest, AnArrowOfKnownFlowIsWhereItMustBe) {
  window::ElementState state;
  state.settings = {{"arrow-scale", "", window::Setting::Kind::kNumber, 5, 0.1, 100, {}}};
  window::Window window(std::make_shared<FakeSource>(state));
  DrawnFrame report;
  // To the right by 8 px: 40 px at this scale, from x = 60 to x = 100.
  report.points.push_back({1, {60, 80}, {68, 80}, PointOwner::kObject, 1, false});
  report.frame.wrench.force_N = {0, -3, 0};  // down, the most there is
  give(window, report);
  Screenshot shot = look(window);
  const window::PictureMap map = map_of(shot);
  const auto color = [&](double x_px, double y_px) {
    const Eigen::Vector2d p = map({x_px, y_px});
    return at(shot, p.x(), p.y());
  };
  const Color faint = color(80, 80);
  EXPECT_TRUE(is_grey(faint)) << "a point of an object that is not felt: " << shown(faint);
  EXPECT_GT(faint.r, 128 + 10) << shown(faint);
  press(window, GLFW_KEY_D);  // with all detail
  shot = look(window);
  // The shaft is 2.5 px wide or more and its ends are soft: a pixel inside each end.
  for (const double x : {61.0, 70.0, 80.0, 90.0, 98.5}) {
    EXPECT_TRUE(is_red(color(x, 80))) << x << ": " << shown(color(x, 80));
  }
  for (const auto& [x, y] : {std::pair{57, 80}, {103, 80}, {75, 77}, {75, 83}}) {
    EXPECT_TRUE(is_grey(color(x, y))) << x << "," << y << ": " << shown(color(x, y));
  }
  // The felt arrow: from the middle, a fifth of the picture's 240 lines long.
  EXPECT_TRUE(is_white(color(159.5, 121)));
  EXPECT_TRUE(is_white(color(159.5, 119.5 + 46)));
  // Six pixels of the window beyond the tip its newtons are written.
  EXPECT_FALSE(is_white(color(159.5, 119.5 + 48 + 5 / map.scale_y)));
  EXPECT_TRUE(is_grey(color(159.5, 112)));
}

TEST_F(WindowTest, HListsTheKeysOverThePicture) {
  window::Window window(std::make_shared<FakeSource>());
  give(window, {}, 200);
  const auto level = [&] {
    const Screenshot shot = look(window);
    const window::Rect picture = window::lay_out(shot.width, shot.height, 1).picture;
    int dark = 0;  // in the line across the middle
    for (double x = picture.x; x < picture.right(); ++x) {
      dark += at(shot, x, picture.y + picture.height / 2).r < 60;
    }
    return dark;
  };
  const int before = level();
  press(window, GLFW_KEY_H);
  EXPECT_GT(level(), before + 100);
  press(window, GLFW_KEY_H);
  EXPECT_EQ(level(), before);
}

TEST_F(WindowTest, ATensionBarHasItsHeight) {
  window::ElementState state;
  state.device.emplace();
  DeviceView& device = *state.device;
  device.name = "known";
  device.geometry.count = 2;
  device.geometry.exit_m[0] = {-0.1, 0, 0};
  device.geometry.exit_m[1] = {0.1, 0, 0};
  device.min_tension_N.head<2>() << 0.5, 0.5;
  device.max_tension_N.head<2>() << 5, 5;
  device.last.tension_N.head<2>() << 4, 1.5;
  window::Window window(std::make_shared<FakeSource>(state));
  const Screenshot shot = look(window);
  const window::Layout layout = window::lay_out(shot.width, shot.height, 1);
  const double fraction[] = {0.8, 0.3};
  for (int i = 0; i < 2; ++i) {
    // The middle of the string's bar is where its column has most of the bar's colours.
    double best = 0, filled = 0;
    const double x0 = layout.tensions.x + i * layout.tensions.width / 2;
    for (double x = x0; x < x0 + layout.tensions.width / 2; ++x) {
      int blue = 0, dark = 0;
      for (double y = layout.tensions.y; y < layout.tensions.bottom(); ++y) {
        const Color c = at(shot, x, y);
        blue += c.b > 200 && c.r < 100;
        dark += c.r == 38 && c.g == 43 && c.b == 53;
      }
      if (blue + dark <= best) continue;
      best = blue + dark;
      filled = blue;
    }
    ASSERT_GT(best, 30) << "string " << i;
    // The mark of the smallest tension covers two lines, for it lies between lines, and both ends
    // may be half covered.
    EXPECT_NEAR(filled, fraction[i] * best, 4) << "string " << i;
  }
}

TEST_F(WindowTest, PAsksThePlayerToPauseAndToPlay) {
  for (const bool is_playing : {true, false}) {
    window::ElementState state;
    state.is_playing = is_playing;
    auto source = std::make_shared<FakeSource>(state);
    window::Window window(source);
    look(window);
    press(window, GLFW_KEY_P);
    EXPECT_EQ(source->wait_for_plays(1)[0], !is_playing);
  }
}

TEST_F(WindowTest, AtTheEndOfTheFilmPPlaysItAgain) {
  window::ElementState state;
  state.is_playing = true;
  state.has_ended = true;
  auto source = std::make_shared<FakeSource>(state);
  window::Window window(source);
  look(window);
  press(window, GLFW_KEY_P);
  EXPECT_EQ(source->wait_for_seeks(1)[0], 0);
  EXPECT_TRUE(source->wait_for_plays(0).empty()) << "it plays already";
}

TEST_F(WindowTest, AClickOnAnObjectChoosesIt) {
  auto source = std::make_shared<FakeSource>();
  window::Window window(source);
  DrawnFrame report;
  MovingObject object;
  object.id = 3;
  object.points = 10;
  object.position_px = {40, -20};
  object.size_px = {60, 60};
  report.frame.objects.push_back(object);
  give(window, report);
  const window::PictureMap map = map_of(look(window));
  const auto click = [&](double x_px, double y_px) {
    window::Mouse mouse;
    mouse.at_px = map({x_px, y_px});
    mouse.down = true;
    set_mouse(window, mouse);
    look(window);
    mouse.down = false;
    set_mouse(window, mouse);
    look(window);
  };
  click(20, 20);       // beside it
  click(199.5, 89.5);  // of a frame of 320 × 240
  FakeSource::Places positions = source->wait_for_choices(1);
  ASSERT_EQ(positions.size(), 1u);
  ASSERT_TRUE(positions[0]);
  EXPECT_NEAR((*positions[0] - Eigen::Vector2d(200.0 / 320, 90.0 / 240)).norm(), 0, 1e-9);
  // Without another frame, as in a pause, its outline is that of an object that is felt: orange.
  const Screenshot clicked = look(window);
  const Eigen::Vector2d edge = map_of(clicked)({159.5 + 40, 119.5 - 20 + 30});
  int orange = 0;
  for (int down = -2; down <= 2; ++down) {
    const Color c = at(clicked, edge.x(), edge.y() + down);
    orange += c.r > 200 && c.g > 140 && c.g < 220 && c.b < 120;
  }
  EXPECT_GT(orange, 0);
  report.click = 1;
  report.frame.felt_object = 3;
  give(window, report);
  look(window);
  click(199.5, 89.5);
  positions = source->wait_for_choices(2);
  EXPECT_FALSE(positions.back()) << "a second click lets go";
}

}  // namespace
}  // namespace spidar::test::window_picture_test
