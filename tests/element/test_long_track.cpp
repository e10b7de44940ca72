// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A track that is longer than what is read ahead of it, played by seeks and backwards.
#include <gst/gst.h>

#include "plugin/films/file_end.h"
#include "plugin/films/file_pipeline.h"
#include "plugin/filter/engine/track_renderer.h"
#include "plugin/tracks/track_loader.h"
#include "tests/support/element_harness.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"
#include "tests/support/wav_track.h"

namespace spidar::test::long_track_test {
namespace {

constexpr int kLength_ms = 60'000;
static_assert(kLength_ms * int64_t{1'000'000} > 4 * ReadAhead::kAhead_ns);
constexpr int kFrame_ms = 40;
constexpr int64_t kMs_ns = 1'000'000;
/// For machines that are much slower than any.
constexpr std::chrono::seconds kLongest{60};

class LongTrack : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    init_gstreamer();
    const std::string wav = folder.path / "long.wav";
    write_track(wav, kLength_ms);
    path = folder.path / (std::string("long.") + GetParam());
    encode(wav);
    loader.begin(path, "");
    loader.await(kLongest);
    const auto loaded = loader.take();
    ASSERT_TRUE(loaded);
    ASSERT_EQ(loaded->error, "");
    EXPECT_EQ(loaded->duration_ns, kLength_ms * kMs_ns);
    blocks = loaded->blocks;
    replay.set_track(blocks);
  }

  void encode(const std::string& wav) const {
    const std::string format = GetParam();
    if (format == "wav") return;
    const std::string encoder =
        format == "flac" ? "audioconvert dithering=none noise-shaping=none ! flacenc blocksize=40"
                         : "matroskamux";
    const FilePipeline file(
        "filesrc name=source ! wavparse ! " + encoder + " ! filesink location=" + path, wav);
    file.play_until(GST_MESSAGE_EOS);
    file.stop();
  }

  /// Plays the frames from one time to another, backwards if that is earlier, and expects all
  /// samples in between, none of them twice or wrong.
  void play(int from_ms, int to_ms) {
    std::map<int64_t, TrackSample> given;
    const int step_ms = from_ms < to_ms ? kFrame_ms : -kFrame_ms;
    ++epoch;
    for (int at_ms = from_ms; at_ms != to_ms; at_ms += step_ms) {
      const FrameStamp frame{epoch, std::min(at_ms, at_ms + step_ms) * kMs_ns, 0,
                             kFrame_ms * kMs_ns, from_ms < to_ms ? 1.0 : -1.0};
      const auto deadline = std::chrono::steady_clock::now() + kLongest;
      do {
        replay.play(frame, [&](const TrackBlock& block) { take(block, at_ms, frame.rate, given); });
      } while (!has(given, std::min(at_ms, at_ms + step_ms)) &&
               std::chrono::steady_clock::now() < deadline);
      ASSERT_TRUE(has(given, std::min(at_ms, at_ms + step_ms))) << at_ms << " ms";
      // FLAC has 24 bits.
      const auto middle = static_cast<double>(std::min(at_ms, at_ms + step_ms) + kFrame_ms / 2);
      EXPECT_GE(replay.largest(frame).force_N.norm(),
                to_wrench(sample_at(middle)).force_N.norm() - 1e-5);
    }
  }

  static bool has(const std::map<int64_t, TrackSample>& given, int begin_ms) {
    for (int ms = begin_ms; ms < begin_ms + kFrame_ms; ++ms) {
      if (given.count(ms) == 0) return false;
    }
    return true;
  }

  /// A block that is given for the frame that is seen from `at_ms` on.
  static void take(const TrackBlock& block, int at_ms, double rate,
                   std::map<int64_t, TrackSample>& given) {
    for (size_t i = 0; i < block.count; ++i) {
      const double ms = at_ms + rate * static_cast<double>(block.time_ns(i)) / kMs_ns;
      const int64_t whole = std::llround(ms);
      EXPECT_NEAR(ms, static_cast<double>(whole), 1e-3);
      EXPECT_TRUE(given.emplace(whole, block.samples[i]).second) << whole << " ms twice";
      for (size_t channel = 0; channel < kTrackChannels; ++channel) {
        ASSERT_NEAR(block.samples[i][channel], sample_at(static_cast<double>(whole))[channel], 1e-6)
            << whole << " ms";
      }
    }
  }

  const TemporaryFolder folder;
  std::string path;
  tracks::Loader loader;
  std::shared_ptr<ReadAhead> blocks;
  filter::TrackReplay replay;
  uint32_t epoch = 0;
};

TEST_P(LongTrack, IsFeltFromOneEndToTheOther) {
  play(0, kLength_ms);
}

/// A copy over the network that fails, or a disk that is full: what takes files apart takes it for
/// the end.
TEST_P(LongTrack, ThatIsCutOffWhileItIsPlayedSaysWhereItEnds) {
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  TrackBlock block;
  int64_t end_ns = 0;
  const auto deadline = std::chrono::steady_clock::now() + kLongest;
  while (blocks->pop(block, deadline) == ReadAhead::Found::kBlock) end_ns = end_of(block);
  EXPECT_LT(end_ns, kLength_ms * kMs_ns);
  const std::string error = blocks->error();
  EXPECT_NE(error.find("cut off while it was played: it ends at "), std::string::npos) << error;
  EXPECT_NE(error.find("was 60.000 s long"), std::string::npos) << error;
  // A jump to what is not there any more changes nothing of that.
  blocks->seek(50'000 * kMs_ns);
  EXPECT_EQ(blocks->pop(block, deadline), ReadAhead::Found::kEnd);
  EXPECT_EQ(blocks->error(), error);
}

TEST_P(LongTrack, IsFeltWhereTheFilmJumps) {
  for (const int ms : {55'000, 1'000, 30'000, 31'000, 29'480, 59'000, 0}) play(ms, ms + 1'000);
}

TEST_P(LongTrack, IsFeltBackwardsToItsBeginning) {
  play(kLength_ms, 0);
}

TEST_P(LongTrack, IsFeltWhereTheFilmTurns) {
  play(20'000, 33'000);
  play(33'000, 21'000);
  play(21'000, 35'000);
}

INSTANTIATE_TEST_SUITE_P(Formats, LongTrack, testing::Values("wav", "flac", "mka"),
                         [](const auto& format) { return std::string(format.param); });

// Of a slow disk. Before, what came late was not given any more.
TEST(TrackReplay, BackwardsNothingIsLeftOutThatComesLate) {
  const auto blocks = std::make_shared<ReadAhead>();
  constexpr int kBlock_ms = 40;
  const auto put = [&](int begin_ms) {
    TrackBlock block;
    block.begin_ns = begin_ms * kMs_ns;
    block.duration_ns = kBlock_ms * kMs_ns;
    block.count = kBlock_ms;
    ASSERT_TRUE(blocks->push(block, {}));
  };
  for (int ms = 0; ms <= 960; ms += kBlock_ms) put(ms);
  blocks->set_interrupted(true);  // nothing waits for the next
  filter::TrackReplay replay;
  replay.set_track(blocks);
  std::vector<int64_t> given_ms;
  const FrameStamp frame{1, 1000 * kMs_ns, 0, kFrame_ms * kMs_ns, -1.0};
  const auto play = [&] {
    replay.play(frame, [&](const TrackBlock& block) {
      given_ms.push_back(1000 + kFrame_ms - block.time_ns(block.count - 1) / kMs_ns);
    });
  };
  play();
  for (int ms = 1000; ms <= 1080; ms += kBlock_ms) put(ms);
  play();
  EXPECT_EQ(given_ms, (std::vector<int64_t>{1000, 960, 920}));
}

TEST(ReadAhead, WhatCannotBeReadFurtherIsSaidWhenAllHasBeenTaken) {
  ReadAhead blocks;
  TrackBlock block;
  block.duration_ns = 40 * kMs_ns;
  block.count = 40;
  EXPECT_TRUE(blocks.push(block, {}));
  blocks.end("it is damaged");
  EXPECT_FALSE(blocks.has_failed());
  const auto now = std::chrono::steady_clock::now();
  EXPECT_EQ(blocks.pop(block, now), ReadAhead::Found::kBlock);
  EXPECT_EQ(blocks.pop(block, now), ReadAhead::Found::kEnd);
  EXPECT_TRUE(blocks.has_failed());
  EXPECT_FALSE(blocks.was_late());
}

TEST(ReadAhead, ABlockThatIsNotThereIsLateAndOneThatIsInterruptedIsNot) {
  ReadAhead blocks;
  TrackBlock block;
  blocks.set_interrupted(true);
  EXPECT_EQ(blocks.pop(block, std::chrono::steady_clock::now() + kLongest),
            ReadAhead::Found::kLate);
  EXPECT_FALSE(blocks.was_late());
  blocks.set_interrupted(false);
  EXPECT_EQ(blocks.pop(block, std::chrono::steady_clock::now()), ReadAhead::Found::kLate);
  EXPECT_TRUE(blocks.was_late());
}

}  // namespace
}  // namespace spidar::test::long_track_test
