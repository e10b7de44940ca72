// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The contents of a debug window, read back from the frame buffer.
#include <chrono>
#include <future>
#include <memory>
#include <thread>

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "tests/window/fake_source.h"
#include "tests/window/window_fixture.h"

namespace spidar::test::window_picture_test {
namespace {

TEST_F(WindowTest, AnArrowOfKnownFlowIsWhereItMustBe) {
  auto feed = std::make_shared<FrameFeed>();
  ElementState state;
  state.settings = {{"arrow-scale", "", Setting::Kind::kNumber, 5, 0.1, 100, {}}};
  Window window(std::make_shared<FakeSource>(state), feed);
  FrameFacts facts;
  // To the right by 8 px: 40 px at this scale, from x = 60 to x = 100.
  facts.scene.tracks.push_back({1, {60, 80}, {68, 80}, TrackOwner::kObject, 1, false});
  facts.scene.wrench.force_N = {0, -3, 0};  // down, the most there is
  give(*feed, facts);
  Screenshot shot = look(window);
  const PictureMap map = map_of(shot);
  const auto color = [&](double x_px, double y_px) {
    const Eigen::Vector2d p = map({x_px, y_px});
    return at(shot, p.x(), p.y());
  };
  const Color faint = color(80, 80);
  EXPECT_FALSE(is_red(faint)) << "a track of an object that is not felt: " << shown(faint);
  EXPECT_GT(faint.r, faint.g + 20) << shown(faint);
  window.press(GLFW_KEY_D);  // with all detail
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

TEST_F(WindowTest, AScreenshotIsOfNoDrawingThatBeganBeforeTheCall) {
  auto source = std::make_shared<FakeSource>();
  auto feed = std::make_shared<FrameFeed>();
  Window window(source, feed);
  FrameFacts facts;
  facts.scene.tracks.push_back({1, {60, 80}, {100, 80}, TrackOwner::kObject, 1, false});
  give(*feed, facts);
  const auto is_detailed = [](const Screenshot& shot) {
    const Eigen::Vector2d p = map_of(shot)({80, 80});
    return is_red(at(shot, p.x(), p.y()));
  };
  ASSERT_FALSE(is_detailed(look(window)));
  // A call that gives up while its drawing is under way. Where the pauses below are too short for a
  // slow machine, the calls come in another order, which is right as well.
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(100)); };
  source->hold_next_drawing();
  auto early = std::async(std::launch::async,
                          [&] { return window.screenshot(std::chrono::milliseconds(300)); });
  pause();
  source->hold_next_drawing();
  EXPECT_FALSE(early.get().has_value());
  window.press(GLFW_KEY_D);
  auto late = std::async(std::launch::async, [&] { return look(window); });
  pause();
  source->draw_on();
  EXPECT_TRUE(is_detailed(late.get()));
}

TEST_F(WindowTest, ATensionBarHasItsHeight) {
  ElementState state;
  state.device.emplace();
  DeviceView& device = *state.device;
  device.name = "known";
  device.geometry.count = 2;
  device.geometry.exit_m[0] = {-0.1, 0, 0};
  device.geometry.exit_m[1] = {0.1, 0, 0};
  device.min_tension_N.head<2>() << 0.5, 0.5;
  device.max_tension_N.head<2>() << 5, 5;
  device.loop.last.tension_N.head<2>() << 4, 1.5;
  Window window(std::make_shared<FakeSource>(state), std::make_shared<FrameFeed>());
  const Screenshot shot = look(window);
  const WindowLayout layout = lay_out(shot.width, shot.height, 1);
  const auto bars = tension_bars(tension_area(layout.tensions, 1), device);
  const double share[] = {0.8, 0.3};
  for (size_t i = 0; i < 2; ++i) {
    const Rect& range = bars[i].range;
    int blue = 0;
    for (double y = range.y + 1.5; y < range.bottom() - 1; ++y) {
      const Color c = at(shot, range.x + range.width / 2, y);
      blue += c.b > 200 && c.r < 100;
    }
    // The loop leaves out two and a half lines at the ends, the mark of the smallest tension covers
    // two, for it lies between lines, and the bar's own end may be half covered.
    EXPECT_NEAR(blue, share[i] * range.height, 5) << "string " << i;
  }
}

TEST_F(WindowTest, APauseHoldsThePictureAndLooksBack) {
  auto feed = std::make_shared<FrameFeed>();
  Window window(std::make_shared<FakeSource>(), feed);
  give(*feed, {}, 60);
  EXPECT_NEAR(level_in(window), 60, 1);
  window.press(GLFW_KEY_P);
  EXPECT_NEAR(level_in(window), 60, 1) << "the small picture of it";
  // Pictures are kept a quarter of a second apart: this one as well, however slow the window is.
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  give(*feed, {}, 160);
  EXPECT_NEAR(level_in(window), 60, 1) << "in a pause it stays";
  window.press(GLFW_KEY_P);
  EXPECT_NEAR(level_in(window), 160, 1) << "and then shows the newest";
  window.press(GLFW_KEY_P);
  EXPECT_NEAR(level_in(window), 160, 1);
  for (int i = 0; i < 600; ++i) window.press(GLFW_KEY_COMMA);
  EXPECT_NEAR(level_in(window), 60, 1) << "the oldest, a minute of steps back";
}

TEST_F(WindowTest, ThePictureIsTheOneOnTheScreenWhoseForceTheGripFeels) {
  ElementState state;
  DeviceView& device = state.device.emplace();
  device.name = "sim";
  device.loop.last.playing = true;
  device.loop.last.running_ns = 1'000'000'000;
  auto feed = std::make_shared<FrameFeed>();
  Window window(std::make_shared<FakeSource>(state), feed);
  FrameFacts facts;
  for (const auto& [running_ns, level] : {std::pair{960'000'000, 60}, {1'040'000'000, 160}}) {
    facts.running_ns = running_ns;
    give(*feed, facts, level);
    look(window);
  }
  EXPECT_NEAR(level_in(window), 60, 1);
}

TEST_F(WindowTest, DraggingAPlotLooksBackAndAClickDoesNot) {
  auto feed = std::make_shared<FrameFeed>();
  Window window(std::make_shared<FakeSource>(), feed);
  give(*feed, {}, 60);
  const Screenshot shot = look(window);
  const Rect plot = lay_out(shot.width, shot.height, 1).force;
  Mouse mouse;
  const auto put = [&](double share, bool down) {
    mouse.at_px = {plot.x + share * plot.width, plot.y + plot.height / 2};
    mouse.down = down;
    window.set_mouse(mouse);
    look(window);
  };
  put(0.5, true);
  put(0.5, false);
  give(*feed, {}, 100);
  EXPECT_NEAR(level_in(window), 100, 1);
  put(0.5, true);
  put(0.6, true);
  give(*feed, {}, 160);
  EXPECT_LE(level_in(window), 101) << "in the past it stays";
}

TEST_F(WindowTest, APeakBetweenTwoPicturesIsPlotted) {
  /// The highest row of the force's plot in which x, which is red, is drawn, from its top.
  const auto highest_red = [](double peak_N) {
    ElementState state;
    DeviceView& device = state.device.emplace();
    device.name = "sim";
    for (const double force_N : {0.0, peak_N, 0.0}) {
      device.wanted.add({0, 0, 0});
      device.delivered.add({force_N, 0, 0});
    }
    auto feed = std::make_shared<FrameFeed>();
    Window window(std::make_shared<FakeSource>(state), feed);
    give(*feed, {});
    look(window);
    look(window);
    const Screenshot shot = look(window);
    const Rect panel = lay_out(shot.width, shot.height, 1).force;
    // Below title and legend.
    for (double y = 0.25 * panel.height; y < panel.height; ++y) {
      for (double x = panel.x + panel.width / 2; x < panel.right(); ++x) {
        const Color c = at(shot, x, panel.y + y);
        if (c.r > 150 && c.g < 0.7 * c.r && c.b < 0.7 * c.r) return y / panel.height;
      }
    }
    return 1.0;
  };
  // The axis goes from -3 to 3 N.
  EXPECT_LT(highest_red(2.5), 0.4);
  EXPECT_GT(highest_red(0), 0.5);
}

TEST_F(WindowTest, AClickOnAnObjectChoosesIt) {
  auto source = std::make_shared<FakeSource>();
  auto feed = std::make_shared<FrameFeed>();
  Window window(source, feed);
  FrameFacts facts;
  MovingObject object;
  object.id = 3;
  object.tracks = 10;
  object.position_px = {40, -20};
  object.size_px = {60, 60};
  facts.scene.objects.push_back(object);
  give(*feed, facts);
  const PictureMap map = map_of(look(window));
  const auto click = [&](double x_px, double y_px) {
    Mouse mouse;
    mouse.at_px = map({x_px, y_px});
    mouse.down = true;
    window.set_mouse(mouse);
    look(window);
    mouse.down = false;
    window.set_mouse(mouse);
    look(window);
  };
  click(20, 20);       // beside it
  click(199.5, 89.5);  // of a frame of 320 × 240
  FakeSource::Places places = source->wait_for_choices(1);
  ASSERT_EQ(places.size(), 1u);
  ASSERT_TRUE(places[0]);
  EXPECT_NEAR((*places[0] - Eigen::Vector2d(200.0 / 320, 90.0 / 240)).norm(), 0, 1e-9);
  facts.settings.kept = {1, *places[0]};
  facts.scene.felt_object = 3;
  give(*feed, facts);
  look(window);
  click(199.5, 89.5);
  places = source->wait_for_choices(2);
  EXPECT_FALSE(places.back()) << "a second click lets go";
  window.press(GLFW_KEY_P);
  click(199.5, 89.5);
  EXPECT_EQ(source->wait_for_choices(2).size(), 2u) << "not in the past";
}

}  // namespace
}  // namespace spidar::test::window_picture_test
