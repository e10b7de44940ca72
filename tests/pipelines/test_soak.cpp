// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Long runs: every frame is felt at its time to the nanosecond, and memory does not grow.
//
// SPIDAR_HOURS is the duration of video (default 0.03), on a stepped clock; `meson test --suite
// soak` runs a day. How late the loop is in real time is a benchmark: spidar-bench loop.
#include <malloc.h>
#include <unistd.h>

#include "tests/pipelines/shown_motion.h"
#include "tests/support/test.h"

namespace spidar::test::soak_test {
namespace {

constexpr int kFrames_Hz = 10;
constexpr GstClockTime kFrame = GST_SECOND / kFrames_Hz;
const std::string kStream =
    "videotestsrc pattern=ball name=source ! video/x-raw,format=GRAY8,width=160,height=120,"
    "framerate=" +
    std::to_string(kFrames_Hz) +
    "/1 ! spidarmotion name=motion ! queue ! fakesink name=sink sync=true";

double hours() {
  const char* text = std::getenv("SPIDAR_HOURS");
  return text ? std::strtod(text, nullptr) : 0.03;
}

/// Bytes that are allocated and not freed.
size_t allocated() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// Bytes of physical memory; 0 where the system does not say.
size_t resident() {
  std::ifstream statm("/proc/self/statm");
  size_t size = 0, pages = 0;
  statm >> size >> pages;
  return pages * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

/// Memory that may be in use at one time and not at another: the frames of a queue, at most one
/// second of them and a few in progress, with their pictures, messages and wrenches; and the same
/// amount again, because lists and rings grow in steps.
constexpr size_t kInFlight = 2 * (kFrames_Hz + 4) * (160 * 120 + 4096);

TEST(Soak, EveryFrameIsFeltAtItsTimeAndMemoryIsFlat) {
  const auto frames = static_cast<uint64_t>(hours() * 3600 * kFrames_Hz);
  const uint64_t warm = frames / 10;
  SteppedPipeline pipeline(kStream);
  pipeline.set_state(GST_STATE_PLAYING);
  size_t before = 0, resident_before = 0;
  uint64_t felt = 0;
  for (uint64_t n = 0; n < frames && !testing::Test::HasFailure(); ++n) {
    const TickRecord tick = pipeline.step();
    const GstClockTime running_time = n * kFrame;
    ASSERT_EQ(pipeline.running_time(), running_time) << "frame " << n << " is missing";
    const auto due_ns = static_cast<int64_t>(running_time);
    const int64_t early_ns = pipeline.early_ns();  // when the motion is felt
    EXPECT_EQ(tick.running_ns, due_ns - early_ns);
    EXPECT_EQ(tick.frame_ns, due_ns - (early_ns > 0 ? static_cast<int64_t>(kFrame) : 0));
    SCOPED_TRACE(n);
    expect_wrench_of(pipeline, tick, running_time);
    felt += tick.wanted.force_N.norm() > 0;
    pipeline.forget_before(running_time);
    if (n == warm) {
      before = allocated();
      resident_before = resident();
    }
  }
  EXPECT_GT(felt, frames / 2) << "nothing was compared with nothing";
  const size_t after = allocated();
  EXPECT_LE(after, before + kInFlight) << frames - warm << " frames later";
  std::printf(
      "%llu frames, %llu of them felt; allocated %zu kB and %zu kB, resident %zu kB and %zu kB\n",
      static_cast<unsigned long long>(frames), static_cast<unsigned long long>(felt), before / 1024,
      after / 1024, resident_before / 1024, resident() / 1024);
}

}  // namespace
}  // namespace spidar::test::soak_test
