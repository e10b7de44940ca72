// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What happens to films and folders while a film is recorded is an error in one sentence, and
// leaves no file that is taken for whole.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "plugin/tools/film_recorder.h"
#include "plugin/tools/processors.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/part_file.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::film_faults_test {
namespace {

namespace fs = std::filesystem;

class FilmFaults : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }
  void SetUp() override {
    make_film("film.avi", "ball");
    fs::create_directory(path("out"));
  }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  void make_film(const std::string& name, const std::string& pattern) const {
    run_pipeline("videotestsrc num-buffers=100 horizontal-speed=3 pattern=" + pattern +
                 " ! video/x-raw,width=160,height=120,framerate=25/1 ! jpegenc ! avimux ! filesink "
                 "location=" +
                 quoted(path(name)));
  }
  /// Records the film. `fault` happens when a tenth of it is done. The error; empty: none.
  std::string record(const std::function<void()>& fault) const {
    try {
      PartFile part(path("out/film.flac"));
      bool is_done = false;
      record_film(path("film.avi"), part, {}, [&](int) {
        if (!std::exchange(is_done, true)) fault();
      });
      EXPECT_TRUE(is_done);
      part.publish();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  }

  TemporaryFolder folder;
};

TEST_F(FilmFaults, AFilmThatGrowsIsNotWhole) {
  const auto grow = [&] { std::ofstream(path("film.avi"), std::ios::app) << "more"; };
  EXPECT_EQ(record(grow), "it was changed while it was read: wait until it is complete");
  EXPECT_TRUE(fs::is_empty(path("out")));
}

TEST_F(FilmFaults, AFilmThatIsReplacedIsNotTheOneThatWasRead) {
  make_film("other.avi", "smpte");
  const auto replace = [&] { fs::rename(path("other.avi"), path("film.avi")); };
  EXPECT_EQ(record(replace), "it was changed while it was read: wait until it is complete");
  EXPECT_TRUE(fs::is_empty(path("out")));
}

TEST_F(FilmFaults, AFilmThatGoesAwayIsAnError) {
  EXPECT_EQ(record([&] { fs::remove(path("film.avi")); }),
            "it was removed while it was read, or its share has gone");
  EXPECT_TRUE(fs::is_empty(path("out")));
}

TEST_F(FilmFaults, AFolderThatGoesAwayIsNamed) {
  EXPECT_EQ(record([&] { fs::remove_all(path("out")); }),
            path("out/film.flac") + ": there is no folder " + path("out"));
  fs::create_directory(path("out"));
  // Where a share was mounted, there is an empty folder.
  const auto unmount = [&] {
    fs::remove_all(path("out"));
    fs::create_directory(path("out"));
  };
  EXPECT_EQ(record(unmount),
            path("out/film.flac") + ": cannot be written: No such file or directory");
  EXPECT_TRUE(fs::is_empty(path("out")));
}

TEST_F(FilmFaults, AClockThatJumpsChangesNothing) {
  const std::string record = "record " + path("film.avi");
  const std::string track = path("film.avi.haptic.flac");
  const auto set_time = [](const std::string& file, std::chrono::hours later) {
    fs::last_write_time(file, fs::file_time_type::clock::now() + later);
  };
  const std::chrono::hours years(24 * 365 * 10);
  set_time(path("film.avi"), years);
  expect_contains(spidartrack(record).text, track);
  for (const auto later : {-years, years, 2 * years}) {
    set_time(track, later);
    expect_contains(spidartrack(record).text, "is there");
  }
}

TEST_F(FilmFaults, TheQuotaOfAControlGroupIsTheLowestOfThoseItIsIn) {
  const auto put = [this](const std::string& name, const std::string& text) {
    fs::create_directories(fs::path(path(name)).parent_path());
    std::ofstream(path(name)) << text << '\n';
  };
  const auto quota = [this](const std::string& groups) {
    return processor_quota(groups, path("cgroup"));
  };
  EXPECT_GT(quota("0::/a/b\n"), 1e6) << "none";
  put("cgroup/a/cpu.max", "150000 100000");
  put("cgroup/a/b/cpu.max", "max 100000");
  EXPECT_EQ(quota("0::/a/b\n"), 1.5);
  EXPECT_EQ(quota("1:name=systemd:/x\n0::/a/b\n"), 1.5);
  EXPECT_GT(quota("0::/c\n"), 1e6);
  put("cgroup/cpu.max", "50000 100000");
  EXPECT_EQ(quota("0::/what/only/the/host/sees\n"), 0.5);
  put("cgroup/cpu/a/cpu.cfs_quota_us", "300000");
  put("cgroup/cpu/a/cpu.cfs_period_us", "100000");
  put("cgroup/cpu/b/cpu.cfs_quota_us", "-1");
  put("cgroup/cpu/b/cpu.cfs_period_us", "100000");
  EXPECT_EQ(quota("3:cpu,cpuacct:/a\n"), 3);
  EXPECT_GT(quota("3:cpuacct,cpu:/b\n2:cpuset:/a\n"), 1e6);
}

TEST_F(FilmFaults, APipelineThatNeverBeginsIsNotAwaitedForEver) {
  GstElement* pipeline =
      gst_parse_launch("fakesrc ! identity drop-probability=1 ! fakesink", nullptr);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  EXPECT_THROW(await_message(pipeline, GST_MESSAGE_EOS, GST_CLOCK_TIME_NONE, 200 * GST_MSECOND),
               SilentFailure);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}

}  // namespace
}  // namespace spidar::test::film_faults_test
