// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The rhythm in which a film shows new pictures, and the recognition of repeated ones.
#include "core/motion/cadence.h"
#include "core/motion/lost_frames.h"
#include "tests/support/test.h"

namespace spidar::test::cadence_test {
namespace {

using Shows = FrameComparison;

constexpr double kSpeed_px_s = 100;

/// Shows pictures taken `picture_Hz` times a second in frames, and returns the intervals of those
/// that did not wait, ms. The first `unseen` repetitions are taken for other pictures, as happens
/// in a film that is coded.
std::vector<double> intervals_ms(Cadence& cadence, double picture_Hz, double frame_Hz, int frames,
                                 int unseen = 0) {
  std::vector<double> found;
  LostFrames lost;
  cadence.cut(0);
  int64_t before = 0;
  RepeatedPicture::Repeats repeats{};
  for (int n = 1; n < frames; ++n) {
    const auto picture = static_cast<int64_t>(n * picture_Hz / frame_Hz + 1e-9);
    const bool again = picture == before;
    const bool is_seen = again && unseen-- <= 0;
    std::rotate(repeats.begin(), repeats.end() - 1, repeats.end());
    repeats.front() = again;  // update() does not ask for this one
    const Cadence::Step step = cadence.update(is_seen ? Shows::kSame : Shows::kOther,
                                              std::llround(1e9 * n / frame_Hz), repeats);
    if (!step.waits && !again) {
      const double interval_s = 1e-9 * static_cast<double>(step.interval_ns);
      found.push_back(1e3 * interval_s);
      // The picture moves equally far each time.
      lost.correction(step.interval_ns, step.shown_for_ns, kSpeed_px_s / picture_Hz / interval_s);
    }
    before = picture;
  }
  return found;
}

// Two repetitions pass for pictures until the noise of coding is known for what it is. What was
// seen until then counts, so that the rhythm need not be learnt from two repetitions more.
TEST(Cadence, KnowsTheIntervalFromTheFirstRepetitionThatIsSeen) {
  constexpr int kUnseen = 2;
  Cadence cadence;
  const std::vector<double> found = intervals_ms(cadence, 24, 30, 120, kUnseen);
  // Four pictures for each repetition, and the first one has no interval. A line through n + 1
  // times, each off by less than a frame: its slope is off by less than 1.5 / n of a frame, n ≥ 8.
  for (size_t i = 4 * (kUnseen + 1) - 1; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], 1e3 / 24, 1.5 / 8 * 1e3 / 30) << i;
  }
}

// A single longer interval among few is not the rhythm: the picture after it is as fast as others.
TEST(Cadence, KeepsTheIntervalOverTheFirstRepetition) {
  constexpr int64_t kFrame_ns = 33'333'333;
  Cadence cadence;
  cadence.cut(0);
  for (int n = 1; n < 8; ++n) {
    const bool again = n == 3;
    const Cadence::Step step = cadence.update(again ? Shows::kSame : Shows::kOther, n * kFrame_ns);
    if (again) continue;
    EXPECT_EQ(step.interval_ns, kFrame_ns) << n;
  }
}

TEST(Cadence, LearnsTheIntervalAnewAtAnotherRateOfPlayback) {
  Cadence cadence;
  intervals_ms(cadence, 48, 120, 240);
  const std::vector<double> found = intervals_ms(cadence, 24, 60, 60);
  // From the fourth picture on; a line through five times, see above.
  for (size_t i = 3; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], 1e3 / 24, 1.5 / 4 * 1e3 / 60) << i;
  }
}

TEST(Cadence, IsTheFrameIntervalWithoutRepeats) {
  // Frames of any length, as a screen is recorded.
  std::mt19937 random(1);
  Cadence cadence;
  LostFrames lost;
  cadence.cut(0);
  int64_t time_ns = 0;
  for (int n = 0; n < 200; ++n) {
    const int64_t interval_ns = 5'000'000 + static_cast<int64_t>(random() % 60'000'000);
    time_ns += interval_ns;
    const Cadence::Step step = cadence.update(Shows::kOther, time_ns);
    EXPECT_FALSE(step.waits);
    EXPECT_EQ(step.interval_ns, interval_ns);
    EXPECT_EQ(lost.correction(step.interval_ns, step.shown_for_ns,
                              1 + static_cast<double>(random() % 100)),
              1);
  }
}

TEST(Cadence, DistinguishesALostFrameFromARepeatedOne) {
  constexpr int64_t kFrame_ns = 40'000'000;
  for (const bool lost : {true, false}) {
    SCOPED_TRACE(lost);
    Cadence cadence;
    LostFrames frames;
    cadence.cut(0);
    int64_t time_ns = 0;
    for (int n = 1; n < 30; ++n) {
      const bool again = n % 12 == 6;
      const bool after = n % 12 == 7;
      const Cadence::Step step =
          cadence.update(again ? Shows::kSame : Shows::kOther, time_ns += kFrame_ns);
      ASSERT_EQ(step.waits, again) << n;
      if (again) continue;
      const double moved_px = kSpeed_px_s * 1e-9 * kFrame_ns * (after && lost ? 2 : 1);
      const double speed_px_s = moved_px / (1e-9 * static_cast<double>(step.interval_ns));
      const double felt_px_s =
          speed_px_s * frames.correction(step.interval_ns, step.shown_for_ns, speed_px_s);
      // Nothing is known until four pictures have been seen, so the first result comes after that.
      EXPECT_NEAR(felt_px_s, kSpeed_px_s, 1e-6) << n;
    }
  }
}

}  // namespace
}  // namespace spidar::test::cadence_test
