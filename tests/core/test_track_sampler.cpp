// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/track/track_format.h"
#include "core/track/track_sampler.h"
#include "tests/support/test.h"

namespace spidar::test::track_sampler_test {
namespace {

Wrench wrench_of(double k) {
  return {{std::sin(k), 2 * std::cos(3 * k), 0.3 * k}, {0.01 * k, 0.1 * std::sin(2 * k), -0.02}};
}

/// Frames that are not whole milliseconds apart, every fifth of which shows the picture before,
/// with motions halfway between two pictures.
std::vector<TimedWrench> film(int frames, int64_t interval_ns) {
  std::vector<TimedWrench> film;
  for (int i = 0; i < frames; ++i) {
    const bool repeated = i % 5 == 4;
    const int shown = repeated ? i - 1 : i;
    const int64_t apart_ns = i == 0 ? 0 : (i % 5 == 0 ? 2 : 1) * interval_ns;
    film.push_back({i * interval_ns, WrenchTimeline::hold_after(interval_ns), wrench_of(shown),
                    repeated, apart_ns / 2});
  }
  return film;
}

TEST(TrackSampler, TakesTheCurveThatIsFeltWhenAllFramesAreKnown) {
  for (const int64_t interval_ns : {8'333'333, 33'366'667, 40'000'000, 90'000'000}) {
    SCOPED_TRACE(interval_ns);
    const std::vector<TimedWrench> frames = film(20, interval_ns);
    WrenchTimeline known;
    for (const TimedWrench& frame : frames) known.push(frame);
    TrackSampler sampler;
    sampler.begin(0);
    int64_t time_ns = 0;
    for (const TimedWrench& frame : frames) {
      ASSERT_TRUE(sampler.add(frame));
      // Repeated frames put off what is settled by up to two intervals.
      while (sampler.next_ns() < sampler.settled_ns(3 * interval_ns)) {
        ASSERT_EQ(sampler.next_ns(), time_ns);
        const Wrench sample = sampler.next();
        const Wrench felt = known.at(time_ns).wrench;
        ASSERT_EQ(sample.stacked(), felt.stacked()) << time_ns;
        time_ns += kTrackPeriod_ns;
      }
    }
    EXPECT_GT(time_ns, 16 * interval_ns);
  }
}

TEST(TrackFormat, FullScaleIsTenNewtonsAndOneNewtonMetre) {
  const TrackSample sample = to_track_sample({{10, -10, 5}, {1, -1, 0.25}});
  EXPECT_EQ(sample, (TrackSample{1, -1, 0.5F, 1, -1, 0.25F}));
  EXPECT_EQ(to_wrench(sample).stacked(), (Wrench{{10, -10, 5}, {1, -1, 0.25}}).stacked());
}

}  // namespace
}  // namespace spidar::test::track_sampler_test
