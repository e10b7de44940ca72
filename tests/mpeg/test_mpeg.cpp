// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Our HJIF read by MPEG's reference software: MPEG_HAPTICS names the folder in which it was built.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/exchange_formats.h"
#include "core/track/track_format.h"
#include "plugin/tools/track_samples.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::mpeg_test {
namespace {

namespace fs = std::filesystem;

constexpr int kSkipped = 77;
constexpr const char* kHelp =
    "MPEG_HAPTICS has to name the folder in which MPEG's reference software for haptics "
    "(MPEGGroup/HapticReferenceSoftware) was built";

/// Path of a program that lies somewhere in the folder; empty when there is none.
std::string program(const std::string& name) {
  const char* folder = std::getenv("MPEG_HAPTICS");
  if (!folder || !fs::is_directory(folder)) return {};
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().filename() == name && entry.is_regular_file()) return entry.path().string();
  }
  return {};
}

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// For the shell; none of the paths here contains a quotation mark.
std::string quoted(const std::string& text) {
  return "'" + text + "'";
}

double largest_difference(const std::vector<TrackSample>& a, const std::vector<TrackSample>& b) {
  double largest = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    for (size_t k = 0; k < kTrackChannels; ++k) {
      largest = std::max(largest, std::fabs(static_cast<double>(a[i][k]) - b[i][k]));
    }
  }
  return largest;
}

double difference(const std::vector<TrackSample>& a, const std::vector<TrackSample>& b) {
  EXPECT_EQ(a.size(), b.size());
  return largest_difference(a, b);
}

std::vector<TrackSample> load(const std::string& path) {
  std::vector<TrackSample> samples;
  tools::read_track(path, [&samples](const TrackSample& sample) { samples.push_back(sample); });
  return samples;
}

void save(const std::string& path, const std::vector<TrackSample>& samples,
          const tools::SaveOptions& options = {}) {
  PartFile part(path, PartFile::Replaces{});
  tools::SampleFile file(path);
  for (const TrackSample& sample : samples) file.add(sample);
  file.flush();
  tools::save_track(part, file, options);
  part.publish();
}

/// Half a step of the 16 bits that the Synthesizer writes, and half a step of our 1e-5.
constexpr double kRounding = 1.0 / 65536 + 0.5e-5;
/// Of what save_track() does without being told otherwise.
constexpr double kTolerance = 4e-4 + kRounding + 1e-6;  // and floats

class Mpeg : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder.path / name).string(); }

  /// The lines that a program prints to stderr. It exits with 255 when all is well, and goes on
  /// after errors, so that its status says nothing. Its JSON schemas are not public: that it has
  /// none is not the fault of a file.
  std::string complaints(const std::string& name, const std::string& arguments) const {
    const std::string line =
        quoted(program(name)) + " " + arguments + " > /dev/null 2> " + quoted(path("stderr"));
    EXPECT_NE(std::system(line.c_str()), -1);
    std::istringstream said(read(path("stderr")));
    std::string rest;
    for (std::string text; std::getline(said, text);) {
      const bool no_schema = text.rfind("The following JSON schema is invalid: ", 0) == 0 &&
                             !fs::exists(text.substr(text.find(": ") + 2));
      if (!no_schema) rest += text + "\n";
    }
    return rest;
  }
  std::vector<TrackSample> synthesized(const std::string& hjif) const {
    EXPECT_EQ(
        complaints("Synthesizer", "-fs 1000 -f " + quoted(hjif) + " -o " + quoted(path("out.wav"))),
        "");
    return load(path("out.wav"));
  }

  /// Ten seconds of a film, as it is recorded.
  std::vector<TrackSample> film() const {
    EXPECT_EQ(
        system(("gst-launch-1.0 -q videotestsrc num-buffers=300 pattern=ball motion=sweep "
                "animation-mode=frames ! "
                "video/x-raw,format=GRAY8,width=320,height=240,framerate=30/1 ! spidarmotion "
                "device=none attach-meta=true ! spidarextract name=x x.wrench ! wavenc ! filesink "
                "location=" +
                quoted(path("film.wav")))
                   .c_str()),
        0);
    return load(path("film.wav"));
  }
  /// Up to the full scale, on six channels at different rates.
  static std::vector<TrackSample> waves() {
    std::vector<TrackSample> track(10000);
    for (size_t i = 0; i < track.size(); ++i) {
      for (size_t k = 0; k < kTrackChannels; ++k) {
        const double phase = 2e-3 * static_cast<double>(i * (k + 1)) + static_cast<double>(k);
        track[i][k] = static_cast<float>(std::sin(phase));
      }
    }
    return track;
  }
  static std::vector<TrackSample> constants() {
    return std::vector<TrackSample>(1000, {0.125F, -0.25F, 0.375F, -0.5F, 0.625F, -0.75F});
  }

  TemporaryFolder folder;
};

TEST_F(Mpeg, EncoderAndSynthesizerReadOurTracks) {
  const std::pair<const char*, std::vector<TrackSample>> tracks[] = {
      {"ten seconds of a film", film()}, {"waves", waves()}, {"six constants", constants()}};
  for (const auto& [name, track] : tracks) {
    SCOPED_TRACE(name);
    ASSERT_GT(largest_difference(track, std::vector<TrackSample>(track.size())), 0.1);
    save(path("in.hjif"), track);
    EXPECT_EQ(complaints("Encoder",
                         "-f " + quoted(path("in.hjif")) + " -o " + quoted(path("encoded.hjif"))),
              "");
    const double of_encoder = difference(load(path("encoded.hjif")), track);
    const double of_synthesizer = difference(synthesized(path("in.hjif")), track);
    std::printf(
        "%s: differs by %.5f of the full scale after the Encoder, %.5f after the "
        "Synthesizer\n",
        name, of_encoder, of_synthesizer);
    EXPECT_LE(of_encoder, kTolerance);
    EXPECT_LE(of_synthesizer, kTolerance);
  }
}

TEST_F(Mpeg, WithoutToleranceOnlyRoundingIsLeft) {
  tools::SaveOptions exact;
  exact.tolerance = 0;
  save(path("in.hjif"), waves(), exact);
  std::vector<TrackSample> read = synthesized(path("in.hjif")), written = waves();
  ASSERT_EQ(read.size(), written.size());
  // Where the last two keyframes are neighbours, as here, the Synthesizer reads the last sample
  // from behind the end of its curve.
  read.pop_back();
  written.pop_back();
  EXPECT_LE(difference(read, written), kRounding + 1.0 / 32768)
      << "the Synthesizer has no 1: its largest value is a step below";
}

TEST_F(Mpeg, AFileThatIsWrongIsNoticed) {
  save(path("in.hjif"), constants());
  std::string text = read(path("in.hjif"));
  const std::string profile = "\"profile\":\"Main\"";
  ASSERT_NE(text.find(profile), std::string::npos);
  text.replace(text.find(profile), profile.size(), "\"profile\":\"None\"");
  std::ofstream(path("wrong.hjif")) << text;
  EXPECT_NE(complaints("Encoder",
                       "-f " + quoted(path("wrong.hjif")) + " -o " + quoted(path("encoded.hjif"))),
            "");
}

}  // namespace
}  // namespace spidar::test::mpeg_test

int main(int argc, char** argv) {
  for (const char* name : {"Encoder", "Synthesizer"}) {
    if (!spidar::test::mpeg_test::program(name).empty()) continue;
    std::printf("skipped: no %s found: %s\n", name, spidar::test::mpeg_test::kHelp);
    return spidar::test::mpeg_test::kSkipped;
  }
  gst_init(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
