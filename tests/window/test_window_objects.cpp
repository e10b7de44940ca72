// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The list of objects in a debug window: pictures, clicks, and what is saved.
#include <memory>

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "tests/window/fake_source.h"
#include "tests/window/window_fixture.h"

namespace spidar::test::window_objects_test {
namespace {

using Eigen::Vector2d;

constexpr int64_t kMillisecond = 1'000'000;
constexpr int kLevel = 128;

class WindowObjects : public WindowTest {
 protected:
  /// Of 320 × 240 px, with two objects whose middles are at a quarter and at three quarters.
  static FrameFacts frame(int64_t ms, const char* path = "/film.avi") {
    FrameFacts facts;
    facts.running_ns = ms * kMillisecond;
    facts.film.path = std::make_shared<const std::string>(path);
    facts.film.stream_ns = ms * kMillisecond;
    facts.film.scene_ns = 0;
    facts.film.length_ns = 10'000 * kMillisecond;
    facts.interval_s = 0.04;
    for (const uint32_t id : {1u, 2u}) {
      MovingObject object;
      object.id = id;
      object.tracks = 10;
      object.position_px = {id == 1 ? -80 : 80, 0};
      object.size_px = {60, 60};
      facts.scene.objects.push_back(object);
    }
    return facts;
  }
  /// The list has objects that were seen for 0.2 s.
  void play(const char* path = "/film.avi") {
    for (const int64_t ms : {0, 100, 300}) {
      give(window, frame(ms, path), kLevel);
      look(window);
    }
  }
  Rect row(size_t i) {
    const Screenshot shot = look(window);
    return object_rows(lay_out(shot.width, shot.height, 1).objects, 1, 2).at(i);
  }
  void click(const Rect& place) {
    Mouse mouse;
    mouse.at_px = {place.right() - 5, place.y + place.height / 2};
    mouse.down = true;
    set_mouse(window, mouse);
    look(window);
    mouse.down = false;
    set_mouse(window, mouse);
    look(window);
  }

  std::shared_ptr<FakeSource> source = std::make_shared<FakeSource>();
  Window window{source};
};

TEST_F(WindowObjects, AreShownWithAPartOfTheFrame) {
  play();
  for (const size_t i : {0, 1}) {
    const Rect picture = row_picture(row(i), 4.0 / 3);
    const Color color =
        at(look(window), picture.x + picture.width / 2, picture.y + picture.height / 2);
    // Averaged and scaled: off by one level at most, as is the conversion.
    EXPECT_NEAR(color.r, kLevel, 2) << i;
    EXPECT_NEAR(color.b, kLevel, 2) << i;
  }
}

TEST_F(WindowObjects, AClickOnARowChoosesUntilTheSceneEndsAndIsSaved) {
  play();
  click(row(1));
  const FakeSource::Places places = source->wait_for_choices(1);
  ASSERT_TRUE(places[0]);
  EXPECT_NEAR((*places[0] - Vector2d(0.75, 0.5)).norm(), 0, 1e-9);
  press(window, GLFW_KEY_C);
  const FakeSource::Saves first = source->wait_for_saves(1);
  EXPECT_EQ(first[0].first, "/film.avi");
  ASSERT_EQ(first[0].second.size(), 1u);
  EXPECT_EQ(first[0].second[0].from_ns, 0);
  EXPECT_EQ(first[0].second[0].to_ns, 340 * kMillisecond);
  EXPECT_EQ(first[0].second[0].place, Vector2d(0.75, 0.5));
  FrameFacts cut = frame(400);
  cut.film.scene_ns = cut.film.stream_ns;
  give(window, cut);
  EXPECT_EQ(source->wait_for_saves(2)[1].second[0].to_ns, 400 * kMillisecond);
  EXPECT_FALSE(source->wait_for_choices(2)[1]) << "it is let go";
}

TEST_F(WindowObjects, AClickOnTheChosenRowLetsGo) {
  play();
  FrameFacts chosen = frame(340);
  chosen.click = 1;
  chosen.scene.felt_object = 1;
  chosen.scene.is_free = false;
  give(window, chosen);
  click(row(0));
  EXPECT_FALSE(source->wait_for_choices(1)[0]);
}

TEST_F(WindowObjects, ChoicesOfALiveSourceAreNotSaved) {
  play("");
  click(row(0));
  EXPECT_TRUE(source->wait_for_choices(1)[0]);
  press(window, GLFW_KEY_C);
  look(window);
  EXPECT_TRUE(source->wait_for_saves(0).empty());
}

TEST_F(WindowObjects, OfAFilmThatIsOverCanStillBeSaved) {
  play("/first.avi");
  click(row(0));
  source->wait_for_choices(1);
  play("/second.avi");
  press(window, GLFW_KEY_C);
  EXPECT_EQ(source->wait_for_saves(1)[0].first, "/first.avi");
}

}  // namespace
}  // namespace spidar::test::window_objects_test
