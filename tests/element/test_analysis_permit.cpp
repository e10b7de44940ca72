// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// exit() while frames are analysed.
#include <unistd.h>

#include "plugin/filter/analysis_permit.h"
#include "tests/support/test.h"

namespace spidar::test::analysis_permit_test {
namespace {

using filter::AnalysisPermit;

std::atomic<bool> frame_begins{false};
std::atomic<bool> frame_ends{false};

void check_the_end() {
  if (!frame_ends) _exit(2);
  _exit(AnalysisPermit() ? 3 : 0);
}

/// Ends the process while another thread analyses a frame, its third one.
[[noreturn]] void exit_in_a_frame() {
  std::thread([] {
    { const AnalysisPermit first; }
    {
      const AnalysisPermit second;
      std::atexit(check_the_end);  // as the destructor of an object that OpenCV makes in a frame
    }
    const AnalysisPermit third;
    frame_begins = true;
    // There are permits until exit() is called.
    while (AnalysisPermit()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    frame_ends = true;
  }).detach();
  while (!frame_begins) std::this_thread::yield();
  std::exit(1);
}

TEST(AnalysisPermit, ExitWaitsForTheFrameAndNoOtherIsAnalysed) {
  // A program that begins anew, for which these frames are the first: what exit() calls follows
  // from their number, and a child of fork() has not begun them.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(exit_in_a_frame(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace spidar::test::analysis_permit_test
