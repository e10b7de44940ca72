// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The curve through frames at random times is exact, smooth, and never outside the range of its
// ends.
#include "tests/core/timeline_frames.h"
#include "tests/support/test.h"

namespace spidar::test::wrench_timeline_random_test {
namespace {

/// Frames at uneven times, also very uneven ones, with jumps and rests.
class RandomFrames : public testing::TestWithParam<uint32_t> {
 protected:
  void SetUp() override {
    std::mt19937 random(GetParam());
    std::uniform_real_distribution<double> force_N(-3, 3);
    std::uniform_int_distribution<int> kind(0, 4);
    int64_t time_ns = 0;
    Wrench wrench;
    for (int i = 0; i < 40; ++i) {
      time_ns += kind(random) == 0 ? 1'000'000 : 4'000'000 * (1 + kind(random));
      if (kind(random) != 0) {
        for (int axis = 0; axis < 3; ++axis) {
          wrench.force_N[axis] = force_N(random);
          wrench.torque_Nm[axis] = 0.1 * force_N(random);
        }
      }
      frames.push_back({time_ns, kHold_ns, wrench});
    }
  }

  std::vector<TimedWrench> frames;
};

TEST_P(RandomFrames, AreMetExactlyAndNeverPassed) {
  WrenchTimeline timeline;
  for (const TimedWrench& frame : frames) timeline.push(frame);
  for (size_t i = 0; i + 1 < frames.size(); ++i) {
    ASSERT_TRUE(same_bits(timeline.at(frames[i].time_ns).wrench, frames[i].wrench));
    const auto a = frames[i].wrench.stacked();
    const auto b = frames[i + 1].wrench.stacked();
    auto last = a;
    for (int step = 1; step < 64; ++step) {
      const int64_t interval_ns = frames[i + 1].time_ns - frames[i].time_ns;
      const auto here = timeline.at(frames[i].time_ns + interval_ns * step / 64).wrench.stacked();
      for (int axis = 0; axis < 6; ++axis) {
        // Up only or down only. A few roundings of numbers up to 3.
        const double way = b[axis] > a[axis] ? 1 : -1;
        ASSERT_GE(way * (here[axis] - last[axis]), -4e-15) << "frame " << i << " of " << GetParam();
        ASSERT_LE(way * (here[axis] - b[axis]), 4e-15) << "frame " << i << " of " << GetParam();
      }
      last = here;
    }
  }
}

TEST_P(RandomFrames, BecomeKnownWithoutAStepNorACorner) {
  // Each some time before its own or, every fourth of them, late.
  std::mt19937 random(GetParam() + 1000);
  std::uniform_int_distribution<int64_t> percent(-60, 200);
  std::vector<int64_t> known_ns{frames[0].time_ns};
  for (size_t i = 1; i < frames.size(); ++i) {
    const int64_t ahead_ns = (frames[i].time_ns - frames[i - 1].time_ns) * percent(random) / 100;
    known_ns.push_back(std::max(known_ns.back(), frames[i].time_ns - ahead_ns));
  }
  constexpr int64_t kStep_ns = 1000;
  constexpr double kStep_s = 1e-9 * kStep_ns;
  // On a way of T ≥ 1 ms over d ≤ 6 N: slope up to 1.5 d/T with level ends or 2 d/T with others,
  // and bent by up to 18 d/T²: 6 from the ends of a cubic, and 4 and 2 times its slopes. One that
  // fades in over others adds theirs, and twice the product of both slopes; of the frames on their
  // way, as many as ever fade at a time here: 4.
  constexpr double kSteepest = 4 * 2 * 6 / 1e-3;
  constexpr double kBent = 4 * 18 * 6 / 1e-6 + 2 * 1.5 / 1e-3 * kSteepest;
  constexpr double kRounding = 4 * 4e-15;
  WrenchTimeline timeline;
  size_t known = 0;
  Eigen::Matrix<double, 6, 1> last = frames[0].wrench.stacked(), lowest = last, highest = last;
  Eigen::Matrix<double, 6, 1> before = last;
  for (int64_t time_ns = frames[0].time_ns; time_ns <= frames[12].time_ns; time_ns += kStep_ns) {
    SCOPED_TRACE(time_ns);
    if (known == 0) timeline.push(frames[known++]);
    const Eigen::Matrix<double, 6, 1> here = timeline.at(time_ns).wrench.stacked();
    ASSERT_LE((here - last).cwiseAbs().maxCoeff(), kSteepest * kStep_s + kRounding);
    ASSERT_LE((here - 2 * last + before).cwiseAbs().maxCoeff(),
              kBent * kStep_s * kStep_s + kRounding);
    for (; known < frames.size() && known_ns[known] <= time_ns; ++known) {
      ASSERT_TRUE(timeline.push(frames[known]));
      ASSERT_LE((timeline.at(time_ns).wrench.stacked() - here).cwiseAbs().maxCoeff(), kRounding);
      lowest = lowest.cwiseMin(frames[known].wrench.stacked());
      highest = highest.cwiseMax(frames[known].wrench.stacked());
    }
    ASSERT_GE((here - lowest).minCoeff(), -kRounding) << "between what is known";
    ASSERT_GE((highest - here).minCoeff(), -kRounding) << "between what is known";
    before = last;
    last = here;
  }
}

INSTANTIATE_TEST_SUITE_P(WrenchTimeline, RandomFrames, testing::Range(1u, 6u));

}  // namespace
}  // namespace spidar::test::wrench_timeline_random_test
