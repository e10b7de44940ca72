// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Why nothing is felt: each reason in the message, in the stats and in the trace.
#include "tests/element/no_force_reason_test.h"
#include "tests/support/test.h"

namespace spidar::test::no_force_reason_test {
namespace {

TEST_F(NoForceReasonTest, EachOfTheFilm) {
  const auto moves = [&] { show_moved(kFrames, 2); };
  const auto stays = [&] { show_moved(kFrames, 0); };
  const auto object_moves = [&] {
    show_picture([](int x, int y, int n) {
      const int left = 20 + 2 * n;
      const bool inside = x >= left && x < left + 100 && y >= 60 && y < 160;
      return static_cast<int>(inside ? texture(y, x - left) : texture(x, y));
    });
  };
  const auto is_plain = [&] { show_picture([](int, int, int n) { return 100 + n; }); };
  struct Case {
    const char* properties;
    std::function<void()> show;
    const char* reason;
  };
  const Case cases[] = {
      {"motion=object", moves, "camera-only"},
      {"motion=camera", object_moves, "objects-only"},
      {"motion=object", [&] { show_noise(); }, "nothing-moves"},
      {"motion=camera", [&] { show_noise(); }, "nothing-moves"},
      {"motion=object", [&] { show_noise(400); }, "few-pictures"},
      {"motion=object", stays, "repeated-frames"},
      {"motion=mean", stays, "repeated-frames"},
      {"motion=object", is_plain, "too-few-points"},
      {"motion=mean", is_plain, "too-few-points"},
      {"motion=mean", [&] { show_moved(1, 2); }, "nothing-to-compare"},
      {"alpha=0.0001", moves, "too-weak"},  // eq. 15: 0.01 N at 50 px/s
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(std::string(each.properties) + ", " + each.reason);
    frames = 0;
    open(std::string("device=sim ") + each.properties);
    play();
    each.show();
    expect_everywhere(each.reason);
    EXPECT_EQ(h->motions().back().repeated, each.reason == std::string("repeated-frames"));
    EXPECT_FALSE(h->motions().front().repeated);
  }
}

TEST_F(NoForceReasonTest, WhileTouchingItIsThatOfThePartOfTheMotionThatIsRendered) {
  open("device=sim motion=camera touch=luma motion-fraction=0");
  play();
  show_moved(kFrames, 2);
  EXPECT_EQ(message_reason(), "too-weak");
  EXPECT_EQ(stats_field("no-force-reason"), "too-weak");
  g_object_set(h->element(), "motion-fraction", 1.0, nullptr);
  show_moved(kFrames, 2);
  EXPECT_EQ(message_reason(), "none");
  EXPECT_EQ(stats_field("no-force-reason"), "none");
  EXPECT_EQ(stats_field("no-force-text"), "");
  EXPECT_EQ(h->motions().back().no_force_text, "");
}

TEST_F(NoForceReasonTest, FramesWithoutAPictureRepeatTheOneBefore) {
  open("device=sim motion=object");
  play();
  show_moved(1, 0);
  show(kFrames, [&](int) {
    GstBuffer* const frame = make_frame(h->info(), 50, 0);  // must not be looked at
    GST_BUFFER_FLAG_SET(frame, GST_BUFFER_FLAG_GAP);
    return frame;
  });
  EXPECT_EQ(stats_field("no-force-reason"), "repeated-frames");
}

TEST_F(NoForceReasonTest, Muted) {
  open("device=sim");
  play();
  show_moved(kFrames, 2);
  EXPECT_EQ(stats_field("no-force-reason"), "none");
  g_object_set(h->element(), "mute", TRUE, nullptr);
  show_moved(1, 2);
  expect_of_device("muted");
  g_object_set(h->element(), "mute", FALSE, nullptr);
  show_moved(4, 2);
  EXPECT_EQ(stats_field("no-force-reason"), "none");
}

TEST_F(NoForceReasonTest, NotPlaying) {
  open("device=sim");
  tick(kOpened_ms);
  show_moved(3, 2);
  expect_of_device("not-playing");
}

TEST_F(NoForceReasonTest, InAPauseTheReasonOfTheFilmStays) {
  open("device=sim");
  play();
  show_moved(kFrames, 2);
  loop().set_playback_clock(PlaybackClock());
  tick(1);
  EXPECT_EQ(stats_field("no-force-reason"), "none");
  EXPECT_EQ(stats_field("device-no-force-reason"), "not-playing");
}

TEST_F(NoForceReasonTest, TheFilmHasEndedOnceItsLastFrameIsOnTheScreen) {
  open("device=sim");
  play();
  show_moved(kFrames, 2);
  gst_harness_push_event(h->harness(), gst_event_new_eos());
  EXPECT_EQ(stats_field("device-no-force-reason"), "none")
      << "two frames are on their way to the screen";
  tick(2 * kFrame_ms);
  EXPECT_EQ(stats_field("device-no-force-reason"), "ended");
  EXPECT_EQ(h->state().feed.no_force.first(h->state().feed.output.snapshot()),
            NoForceReason::kEnded);
  tick(2000);
  EXPECT_EQ(h->state().feed.no_force.first(h->state().feed.output.snapshot()),
            NoForceReason::kEnded)
      << "and not late";
}

TEST_F(NoForceReasonTest, TheDeviceIsNotRunningYet) {
  open("device=sim");
  tick(kOpened_ms / 3);
  show_moved(2, 2);
  expect_of_device("device-starting");
}

TEST_F(NoForceReasonTest, TheDeviceDoesNotAnswer) {
  open("device=sim");
  play();
  show_moved(kFrames, 2);
  device().set_fault(LinkFault::kGone);
  show_moved(2, 2);
  expect_of_device("device-lost");
}

TEST_F(NoForceReasonTest, ThePlaceOfTheGripIsNotKnown) {
  open("device=sim");
  play();
  show_moved(kFrames, 2);
  // String lengths that fit no pose, by centimetres.
  for (int string = 0; string < 8; ++string) {
    device().set_count_error(string, string % 3 == 0 ? 3000 : -1000 * string);
  }
  show_moved(5, 2);  // 200 ms
  expect_of_device("grip-unknown");
}

TEST_F(NoForceReasonTest, TheVideoHasEnded) {
  open("device=sim motion=object");
  play();
  show_moved(kFrames, 2);
  EXPECT_EQ(stats_field("no-force-reason"), "camera-only");
  tick(1200);
  EXPECT_EQ(stats_field("no-force-reason"), "no-frames");
}

TEST_F(NoForceReasonTest, FramesThatComeTooLate) {
  open("device=sim");
  play();
  tick(2000);
  // Each is known a second after it should have been shown.
  for (int n = 0; n < kFrames; ++n) {
    h->push_moved(2.0 * n, 0, static_cast<GstClockTime>(1000 + n * kFrame_ms) * GST_MSECOND);
    tick(kFrame_ms);
  }
  expect_of_device("late");
}

TEST_F(NoForceReasonTest, WithoutADeviceTheFilmHasItsOwnReasons) {
  open("device=none");
  show_moved(kFrames, 2);
  expect_of_device("no-device");
  open("device=none motion=object");
  frames = 0;
  show_moved(kFrames, 2);
  EXPECT_EQ(message_reason(), "camera-only");
  EXPECT_EQ(stats_field("no-force-reason"), "camera-only");
  EXPECT_EQ(h->motions().back().device_no_force, "no-device");
}

TEST_F(NoForceReasonTest, OfAFrameItIsItsOwnAndNotThatOfASecond) {
  open("device=sim motion=camera filter-min-cutoff=0");
  play();
  show_moved(5, 0);
  EXPECT_EQ(message_reason(), "repeated-frames");
  show(1, [&](int) { return make_frame(h->info(), 4, 0); });
  EXPECT_EQ(message_reason(), "none");
  // A picture that is repeated goes on for a while; a cut does not.
  show(1, [&](int) { return make_frame(h->info(), 4000, 4000); });
  EXPECT_EQ(message_reason(), "nothing-to-compare");
  EXPECT_EQ(stats_field("no-force-reason"), "none") << "something was felt in the last second";
}

}  // namespace
}  // namespace spidar::test::no_force_reason_test
