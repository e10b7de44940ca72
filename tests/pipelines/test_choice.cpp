// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What a person chooses in a player: by the mouse in its window, and by rules.
#include <gst/video/navigation.h>

#include "tests/pipelines/chosen_film.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::choice_test {
namespace {

using Eigen::Vector2d;
using Film = ChosenFilm;
constexpr int kWidth = Film::kWidth, kHeight = Film::kHeight, kKnown = Film::kKnown;
constexpr double kMaxFrames = Film::kMaxFrames;

/// What a window of half the size sends that shows the picture mirrored.
constexpr const char* kMirroredWindow =
    " ! videoscale ! video/x-raw,width=240,height=135,pixel-aspect-ratio=1/1 ! "
    "videoflip video-direction=horiz";

Vector2d in_window_px(const Vector2d& position) {
  return {(1 - position.x()) * kWidth / 2, position.y() * kHeight / 2};
}

void move(const Film& film, const Vector2d& position) {
  const Vector2d at_px = in_window_px(position);
  gst_harness_push_upstream_event(
      film.harness(),
      gst_navigation_event_new_mouse_move(at_px.x(), at_px.y(), GST_NAVIGATION_MODIFIER_NONE));
}

void click(const Film& film, const Vector2d& position, gint button = 1) {
  const Vector2d at_px = in_window_px(position);
  gst_harness_push_upstream_event(
      film.harness(), gst_navigation_event_new_mouse_button_press(button, at_px.x(), at_px.y(),
                                                                  GST_NAVIGATION_MODIFIER_NONE));
  gst_harness_push_upstream_event(
      film.harness(), gst_navigation_event_new_mouse_button_release(button, at_px.x(), at_px.y(),
                                                                    GST_NAVIGATION_MODIFIER_NONE));
}

TEST(Mouse, OnItsPathOverThreeObjectsEachIsFelt) {
  Film film("motion=objects pointer=mouse", kMirroredWindow);
  film.play_to(kKnown);
  int right = 0;
  constexpr int kFramesEach = 18;
  for (const int disc : {0, 1, 2}) {
    for (int n = 0; n < kFramesEach; ++n) {
      move(film, film.disc_position(disc));
      film.next();
      right += film.felt() == disc;
    }
  }
  EXPECT_GE(right, kMaxFrames * 3 * kFramesEach);
  EXPECT_TRUE(film.warnings_.empty());
}

TEST(Mouse, AClickKeepsTheObjectAndASecondOneLetsGo) {
  for (const char* motion : {"motion=objects ", "motion=object "}) {
    SCOPED_TRACE(motion);
    Film film(std::string(motion) + "pointer=mouse", kMirroredWindow);
    film.play_to(10);
    move(film, film.disc_position(2));
    click(film, film.disc_position(2));
    move(film, film.disc_position(0));
    int right = 0;
    for (int n = 10; n < 30; ++n) {
      film.next();
      // Alone: the others have no part in its motion.
      right += film.object_ != 0 && film.off_px_s(2) < 0.1 * 75;
    }
    EXPECT_GE(right, kMaxFrames * 20);
    const guint kept = film.object_;
    click(film, film.disc_position(0), 3);
    film.next();
    EXPECT_EQ(film.object_, kept) << "another button";
    click(film, film.disc_position(0));
    for (int n = 31; n < 40; ++n) {
      move(film, film.disc_position(0));
      film.next();
    }
    if (std::string(motion) == "motion=objects ") {
      EXPECT_EQ(film.object_, 0u);
      EXPECT_EQ(film.felt(), 0);
    }
    EXPECT_TRUE(film.warnings_.empty());
  }
}

TEST(Mouse, AClickBesideAllObjectsIsToldAndKeepsNone) {
  Film film("motion=objects pointer=mouse", kMirroredWindow);
  film.play_to(10);
  click(film, {0.02, 0.98});
  film.play_to(30);
  ASSERT_EQ(film.notes_.size(), 1u);
  EXPECT_EQ(film.notes_[0], "No object is at 0.02,0.98, where the mouse was clicked.");
  click(film, film.disc_position(1));
  film.play_to(32);
  EXPECT_NE(film.object_, 0u) << "the next click is a first one";
  EXPECT_EQ(film.felt(), 1);
}

TEST(Mouse, EventsGoOnUpstreamWithTheirPlaceInTheFrame) {
  for (const char* pointer : {"0.5,0.5", "mouse"}) {
    Film film(std::string("pointer=") + pointer, kMirroredWindow);
    film.play_to(2);
    while (GstEvent* const event = gst_harness_try_pull_upstream_event(film.harness()))
      gst_event_unref(event);
    click(film, {0.25, 0.5});
    GstEvent* const event = gst_harness_try_pull_upstream_event(film.harness());
    ASSERT_NE(event, nullptr);
    ASSERT_EQ(GST_EVENT_TYPE(event), GST_EVENT_NAVIGATION);
    gint button = 0;
    gdouble x = 0, y = 0;
    EXPECT_TRUE(gst_navigation_event_parse_mouse_button_event(event, &button, &x, &y));
    // A pixel of the window is two of the frame.
    EXPECT_NEAR(x, 0.25 * kWidth, 2);
    EXPECT_NEAR(y, 0.5 * kHeight, 2);
    gst_event_unref(event);
  }
}

std::string object_at(int disc, int n) {
  const Vector2d at_px = Film::disc_px(disc, n);
  return "object at " + std::to_string(0.5 + at_px.x() / kWidth) + "," +
         std::to_string(0.5 + at_px.y() / kHeight);
}

TEST(Feel, ChoosesLiveByRules) {
  Film film("feel=\"0-0.8 " + object_at(1, 0) + "; 0.8-1.6 " + object_at(2, 20) + "\"");
  film.play_to(kKnown);
  int right = 0;
  for (int n = kKnown; n < 40; ++n) {
    film.next();
    right += film.object_ != 0 && film.felt() == (n < 20 ? 1 : 2);
  }
  EXPECT_GE(right, kMaxFrames * (40 - kKnown));
  film.set("feel", "1.6- " + object_at(0, 40));
  film.play_to(42);
  EXPECT_EQ(film.felt(), 0) << "set while it plays";
  film.set("feel", "nothing");
  film.next();
  EXPECT_EQ(film.velocity_px_s_, Vector2d(0, 0));
  EXPECT_TRUE(film.warnings_.empty());
}

/// As the debug window does when choices are saved.
TEST(Feel, WhatIsSavedHoldsAtOnce) {
  const TemporaryFolder folder;
  const std::string path = folder.path / "film.feel";
  std::ofstream(path) << "0-1.6 " + object_at(1, 0) + "\n";
  Film film("feel=" + path);
  film.play_to(20);
  EXPECT_EQ(film.felt(), 1);
  const Vector2d later_px = Film::disc_px(2, 25);
  const FeelEdit edit{GST_SECOND, 2 * GST_SECOND,
                      Vector2d(0.5 + later_px.x() / kWidth, 0.5 + later_px.y() / kHeight)};
  EXPECT_TRUE(film.window().save("", {edit}).is_done);
  int right = 0;
  for (int n = 20; n < 50; ++n) {
    film.next();
    right += film.felt() == (n < 25 ? 1 : 2);
  }
  EXPECT_GE(right, kMaxFrames * 30) << "the rule that was cut goes on with its object";
  EXPECT_TRUE(film.warnings_.empty());
  window::ElementState state;
  film.window().read(state);
  ASSERT_TRUE(state.rules);
  EXPECT_EQ(state.rules->rules().size(), 2u);
}

TEST(Feel, WhatCannotBeSavedIsToldAndChangesNothing) {
  Film film("feel=largest");
  film.play_to(kKnown);
  const FeelEdit edit{0, GST_SECOND, Vector2d(0.5, 0.5)};
  const window::ChoicesSaved none = film.window().save("", {edit});
  EXPECT_FALSE(none.is_done);
  EXPECT_EQ(none.what,
            "Not saved: what is played comes from no file, beside which rules could be kept.");
  EXPECT_EQ(film.window().save("/nowhere/film.avi", {edit}).what,
            "Not saved: film.avi.feel: cannot be written: there is no folder /nowhere.");
  film.next();
  window::ElementState state;
  film.window().read(state);
  ASSERT_TRUE(state.rules);
  EXPECT_EQ(state.rules->text(), "largest");
}

TEST(Feel, MistakesAreNamedOnceAndTheVideoGoesOn) {
  const std::pair<std::string, std::string> mistakes[] = {
      {"0-1 camera; 1-2 bigest",
       "feel, line 2: \"bigest\" is none of: object at X,Y; largest; "
       "leftmost; rightmost; topmost; bottommost; box [NAME]; region X,Y to X,Y; "
       "camera; nothing."},
      {"/nowhere/film.feel", "/nowhere/film.feel: it cannot be read: No such file or directory."},
      {"0.4- object at 0.02,0.98", "feel, line 1: no object was at 0.02,0.98 at 0:00.4."}};
  for (const auto& [feel, warning] : mistakes) {
    SCOPED_TRACE(feel);
    Film film("feel=\"" + feel + "\"");
    film.play_to(40);
    ASSERT_EQ(film.warnings_.size(), 1u);
    EXPECT_EQ(film.warnings_[0], warning);
    EXPECT_EQ(gst_harness_buffers_received(film.harness()), 40u);
  }
  Film mean("motion=mean feel=largest");
  mean.play_to(5);
  ASSERT_EQ(mean.warnings_.size(), 1u);
  EXPECT_EQ(mean.warnings_[0], "With motion=mean, no objects are known, and feel is not used.");
}

}  // namespace
}  // namespace spidar::test::choice_test
