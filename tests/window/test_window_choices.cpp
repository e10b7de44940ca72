// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Objects that are chosen by clicks in a debug window, and what of that is saved.
#include <GLFW/glfw3.h>

#include "tests/support/test.h"
#include "tests/window/fake_source.h"
#include "tests/window/window_fixture.h"

namespace spidar::test::window_choices_test {
namespace {

using Eigen::Vector2d;

constexpr int64_t kMillisecond = 1'000'000;

class WindowChoices : public WindowTest {
 protected:
  /// Of 320 × 240 px, with two objects whose middles are at a quarter and at three quarters.
  static DrawnFrame frame(int64_t ms, const char* path = "/film.avi") {
    DrawnFrame report;
    report.stamp.stream_ns = report.stamp.running_ns = ms * kMillisecond;
    report.film.path = std::make_shared<const std::string>(path);
    report.film.begin_ns = 0;
    report.film.length_ns = 10'000 * kMillisecond;
    report.frame.interval_ns = 40 * 1'000'000;
    for (const uint32_t id : {1u, 2u}) {
      MovingObject object;
      object.id = id;
      object.points = 10;
      object.position_px = {id == 1 ? -80 : 80, 0};
      object.size_px = {60, 60};
      report.frame.objects.push_back(object);
    }
    return report;
  }
  void play(const char* path = "/film.avi") {
    for (const int64_t ms : {0, 100, 300}) {
      give(window, frame(ms, path));
      look(window);
    }
  }
  void click(uint32_t object) {
    window::Mouse mouse;
    mouse.at_px = map_of(look(window))({object == 1 ? 79.5 : 239.5, 119.5});
    for (const bool down : {true, false}) {
      mouse.down = down;
      set_mouse(window, mouse);
      look(window);
    }
  }

  std::shared_ptr<FakeSource> source = std::make_shared<FakeSource>();
  window::Window window{source};
};

TEST_F(WindowChoices, HoldUntilTheSceneEndsAndAreSaved) {
  play();
  click(2);
  const FakeSource::Places positions = source->wait_for_choices(1);
  ASSERT_TRUE(positions[0]);
  EXPECT_NEAR((*positions[0] - Vector2d(0.75, 0.5)).norm(), 0, 1e-9);
  press(window, GLFW_KEY_C);
  const FakeSource::Saves first = source->wait_for_saves(1);
  EXPECT_EQ(first[0].first, "/film.avi");
  ASSERT_EQ(first[0].second.size(), 1u);
  EXPECT_EQ(first[0].second[0].from_ns, 0);
  EXPECT_EQ(first[0].second[0].to_ns, 340 * kMillisecond);
  EXPECT_EQ(first[0].second[0].position, Vector2d(0.75, 0.5));
  DrawnFrame cut = frame(400);
  cut.film.begin_ns = cut.stamp.stream_ns;
  give(window, cut);
  EXPECT_EQ(source->wait_for_saves(2)[1].second[0].to_ns, 400 * kMillisecond);
  EXPECT_FALSE(source->wait_for_choices(2)[1]) << "it is let go";
}

TEST_F(WindowChoices, SavedOnesAreSavedAgainWhenTheWindowIsClosed) {
  play();
  click(2);
  press(window, GLFW_KEY_C);
  source->wait_for_saves(1);
  give(window, frame(500));
  look(window);
  window.close();
  EXPECT_EQ(source->wait_for_saves(2)[1].second[0].to_ns, 540 * kMillisecond);
}

TEST_F(WindowChoices, OfAFilmThatIsOverCanStillBeSaved) {
  play("/first.avi");
  click(1);
  source->wait_for_choices(1);
  play("/second.avi");
  press(window, GLFW_KEY_C);
  EXPECT_EQ(source->wait_for_saves(1)[0].first, "/first.avi");
}

}  // namespace
}  // namespace spidar::test::window_choices_test
