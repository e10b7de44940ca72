// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Tracks for those without a SPIDAR: one channel as sound, funscripts, vibrations.
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "plugin/tools/track_samples.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::track_conversion_test {
namespace {

class TrackConversion : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }
  std::string path(const std::string& name) const { return (folder.path / name).string(); }

  TemporaryFolder folder;
};

/// Root mean square.
double size_of(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value) * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST_F(TrackConversion, AnOptionThatChangesNothingIsAnError) {
  save_track(path("a.wav"), std::vector<TrackSample>(100));
  const auto refuse = [this](const std::string& options, const std::string& why) {
    const CommandResult result = spidartrack("convert " + path("a.wav") + " " + options);
    EXPECT_EQ(result.status, 2) << options;
    expect_contains(result.text, why);
  };
  refuse(path("b.wav") + " --axis fy", "--axis is for .funscript, and for sound with --rate");
  refuse(path("b.hjif") + " --axis fy", "--axis is for .funscript, and for sound with --rate");
  refuse(path("b.flac") + " --tolerance 0.1", "--tolerance is for .hjif and .ahap, not for ");
  EXPECT_EQ(
      spidartrack("convert " + path("a.wav") + " " + path("b.hjif") + " --tolerance 0.1").text, "");
}

// For a bass shaker: a channel alone, at the rate of sound cards, with nothing that was not there.
TEST_F(TrackConversion, AChannelBecomesSoundWithoutImages) {
  std::vector<TrackSample> track(4000);
  for (size_t i = 0; i < track.size(); ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    track[i] = {0.1F, 0.5F, static_cast<float>(0.4 * std::sin(2 * M_PI * 40 * t)), 0, 0, 0};
  }
  save_track(path("a.wav"), track);
  const CommandResult done =
      spidartrack("convert " + path("a.wav") + " " + path("b.wav") + " --axis fz --rate 48000");
  ASSERT_EQ(done.status, 0) << done.text;
  expect_contains(done.text, "lost: fx up to 1 N, fy up to 5 N\n");

  const auto sound = [&](const std::string& filter) {
    EXPECT_EQ(run("ffmpeg -nostdin -v error -y -i " + path("b.wav") + " -af " + filter +
                  " -f f32le -ac 1 " + path("raw"))
                  .text,
              "");
    std::ifstream file(path("raw"), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
    return values;
  };
  const std::vector<float> all = sound("anull");
  // audioresample may leave out a part of its filter's length at the end.
  EXPECT_NEAR(static_cast<double>(all.size()), 4 * 48000, 0.05 * 48000);
  // 2.5 %: what begins and ends within a period.
  EXPECT_NEAR(size_of(all), 0.4 / std::sqrt(2), 0.007);
  // Images of 40 Hz would lie at 960 and 1040 Hz, as large as the tone for a hold of each sample.
  const std::vector<float> high = sound("highpass=f=700,highpass=f=700");
  EXPECT_LT(size_of({high.begin() + 24000, high.end() - 24000}), 0.001);
}

TEST_F(TrackConversion, AFunscriptIsReadIntoOneChannel) {
  std::ofstream(path("a.funscript")) << R"({"actions":[{"at":0,"pos":50},{"at":100,"pos":100}]})";
  const CommandResult done =
      spidartrack("convert " + path("a.funscript") + " " + path("b.wav") + " --axis fx");
  ASSERT_EQ(done.status, 0) << done.text;
  EXPECT_EQ(done.text, "");
  const std::vector<TrackSample> track = load_track(path("b.wav"));
  ASSERT_EQ(track.size(), 101u);
  EXPECT_NEAR(track[50][0], 0.5, 1e-6);
  EXPECT_EQ(track[100][0], 1);
  EXPECT_EQ(track[50][1], 0);
  const CommandResult back = spidartrack("convert " + path("b.wav") + " " + path("c.funscript"));
  EXPECT_EQ(back.text, "lost: fx up to 10 N, steps of fy below 0.2 N\n");
  const CommandResult telephone = spidartrack("convert " + path("b.wav") + " " + path("c.ahap"));
  EXPECT_EQ(telephone.text, "lost: the direction of the force\n");
}

}  // namespace
}  // namespace spidar::test::track_conversion_test
