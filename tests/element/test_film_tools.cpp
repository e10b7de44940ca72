// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What spidartrack finds out of the system, and how long it waits.
#include <filesystem>
#include <fstream>
#include <string>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "plugin/tools/processors.h"
#include "plugin/tools/track_samples.h"
#include "tests/support/element_harness.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::film_tools_test {
namespace {

namespace fs = std::filesystem;

TEST(FilmTools, TheQuotaOfAControlGroupIsTheLowestOfThoseItIsIn) {
  const TemporaryFolder folder;
  const auto put = [&](const std::string& name, const std::string& text) {
    fs::create_directories((folder.path / name).parent_path());
    std::ofstream(folder.path / name) << text << '\n';
  };
  const auto quota = [&](const std::string& groups) {
    return processor_quota(groups, folder.path);
  };
  EXPECT_GT(quota("0::/a/b\n"), 1e6) << "none";
  put("a/cpu.max", "150000 100000");
  put("a/b/cpu.max", "max 100000");
  EXPECT_EQ(quota("0::/a/b\n"), 1.5);
  EXPECT_EQ(quota("1:name=systemd:/x\n0::/a/b\n"), 1.5);
  EXPECT_GT(quota("0::/c\n"), 1e6);
  put("cpu.max", "50000 100000");
  EXPECT_EQ(quota("0::/what/only/the/host/sees\n"), 0.5);
  put("cpu/a/cpu.cfs_quota_us", "300000");
  put("cpu/a/cpu.cfs_period_us", "100000");
  put("cpu/b/cpu.cfs_quota_us", "-1");
  put("cpu/b/cpu.cfs_period_us", "100000");
  EXPECT_EQ(quota("3:cpu,cpuacct:/a\n"), 3);
  EXPECT_GT(quota("3:cpuacct,cpu:/b\n2:cpuset:/a\n"), 1e6);
}

TEST(FilmTools, APipelineThatNeverBeginsIsNotAwaitedForEver) {
  init_gstreamer();
  GstElement* pipeline =
      gst_parse_launch("fakesrc ! identity drop-probability=1 ! fakesink", nullptr);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  EXPECT_THROW(await_message(pipeline, GST_MESSAGE_EOS, GST_CLOCK_TIME_NONE, 200 * GST_MSECOND),
               SilentFailure);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}

}  // namespace
}  // namespace spidar::test::film_tools_test
