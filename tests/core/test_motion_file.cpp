// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What is measured of a film is read as it was written, and a bad file is refused in a sentence.
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/analysis/cbor_items.h"
#include "core/analysis/motion_file.h"
#include "core/analysis/motion_replay.h"
#include "tests/core/motion_rows.h"

namespace spidar::test::motion_file_test {
namespace {

void expect_same(const MovingObject& a, const MovingObject& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.position_px, b.position_px);
  EXPECT_EQ(a.size_px, b.size_px);
  EXPECT_EQ(a.relative_px_s, b.relative_px_s);
  EXPECT_EQ(a.on_screen_px_s, b.on_screen_px_s);
  EXPECT_EQ(a.growth_1_s, b.growth_1_s);
  EXPECT_EQ(a.roll_rad_s, b.roll_rad_s);
  EXPECT_EQ(a.error_px_s, b.error_px_s);
  EXPECT_EQ(a.area_px2, b.area_px2);
  EXPECT_EQ(a.prominence, b.prominence);
  EXPECT_EQ(a.tracks, b.tracks);
  EXPECT_EQ(a.model, b.model);
}

void expect_same(const MeasuredFrame& a, const MeasuredFrame& b) {
  EXPECT_EQ(a.shown, b.shown);
  EXPECT_EQ(a.anew, b.anew);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.features, b.features);
  EXPECT_EQ(a.interval_ns, b.interval_ns);
  EXPECT_EQ(a.shown_for_ns, b.shown_for_ns);
  EXPECT_EQ(a.votes, b.votes);
  EXPECT_EQ(a.dominant, b.dominant);
  ASSERT_EQ(a.background.has_value(), b.background.has_value());
  if (a.background) {
    EXPECT_EQ(a.background->model.kind, b.background->model.kind);
    EXPECT_EQ(a.background->model.shift_px, b.background->model.shift_px);
    EXPECT_EQ(a.background->model.linear, b.background->model.linear);
    EXPECT_EQ(a.background->sigma_px, b.background->sigma_px);
    EXPECT_EQ(a.background->coverage, b.background->coverage);
  }
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (size_t i = 0; i < a.objects.size(); ++i) expect_same(a.objects[i], b.objects[i]);
}

/// Why the file cannot be read; empty when it can. Then every frame of it can be felt.
std::string refused(const std::string& bytes) {
  try {
    const auto file = std::make_shared<MotionFile>(read_motion(bytes));
    MotionReplay replay;
    replay.set_file(file, 0);
    for (size_t i = 0; i < file->size(); ++i) {
      const std::optional<FrameAnalysis> felt = replay.at(file->moment(i).stream_ns, 1);
      if (felt) {
        EXPECT_TRUE(felt->wrench.stacked().allFinite());
      }
    }
    return {};
  } catch (const MotionFileError& error) {
    return error.what();
  }
}

TEST(MotionFile, IsReadAsItWasWritten) {
  // More than two chunks.
  const MeasuredFilm film = random_film(1, 2 * MotionFileWriter::kChunkFrames + 100);
  const MotionFile file = read_motion(film.file({"film", "quality=fine", false}));
  EXPECT_EQ(file.header().film, "film");
  EXPECT_EQ(file.header().settings, "quality=fine");
  ASSERT_EQ(file.size(), film.frames.size());
  MeasuredFrame read;
  for (size_t i = 0; i < file.size(); ++i) {
    SCOPED_TRACE(i);
    const MotionMoment moment = file.moment(i);
    EXPECT_EQ(moment.kind, film.moments[i].kind);
    EXPECT_EQ(moment.stream_ns, film.moments[i].stream_ns);
    EXPECT_EQ(moment.duration_ns, film.moments[i].duration_ns);
    EXPECT_EQ(moment.empty, film.moments[i].empty);
    const Eigen::Vector2d slope(2, 1);
    EXPECT_EQ(moment.turn.to_shown(slope), film.moments[i].turn.to_shown(slope));
    if (moment.kind != MomentKind::kFrame) continue;
    file.load(i, read);
    if (read.shown == Shown::kWaiting) continue;
    expect_same(read, film.frames[i]);
  }
}

TEST(MotionFile, KeepsThePapersMeanToTheLastBit) {
  MeasuredFrame frame;
  frame.shown = Shown::kOther;
  frame.width = 64;
  frame.height = 48;
  frame.interval_ns = frame.shown_for_ns = kMeasuredFrame_ns;
  frame.mean.velocity_px_s = {1.0 / 3, -std::sqrt(2)};
  frame.mean.tracked = 77;
  MotionFileWriter writer;
  std::string bytes = write_header({{}, {}, true});
  writer.add({}, frame, bytes);
  writer.finish(bytes);
  MeasuredFrame read;
  read_motion(bytes).load(0, read);
  EXPECT_EQ(read.mean.velocity_px_s, frame.mean.velocity_px_s);
  EXPECT_EQ(read.mean.tracked, 77);
}

TEST(MotionFile, RoundsToHalfAPerMilleAndOnce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-14, 15);
  for (int n = 0; n < 10000; ++n) {
    const double value = std::exp2(exponent(random)) * (n % 2 ? 1 : -1);
    // Half a step of 11 bits, and of the 24 bits on the way.
    EXPECT_NEAR(from_half(to_half(value)), value,
                (std::exp2(-11) + std::exp2(-24)) * std::fabs(value));
  }
  EXPECT_EQ(from_half(to_half(1e9)), 65504) << "the largest there is";
  EXPECT_EQ(from_half(to_half(std::numeric_limits<double>::quiet_NaN())), 0);
  EXPECT_EQ(from_half(0x7c00), 0) << "infinity, which to_half() does not give";
  for (const MeasuredFrame& frame : random_film(2, 500).frames) {
    MeasuredFrame again = frame;  // has been rounded
    round_measured(again);
    expect_same(again, frame);
  }
}

TEST(MotionFile, HasAnEndAndIsWholeUntilThere) {
  const std::string bytes = random_film(3, 60).file();
  EXPECT_EQ(refused(bytes), "");
  for (size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_NE(refused(bytes.substr(0, length)), "") << length;
  }
  EXPECT_EQ(refused(bytes.substr(0, bytes.size() - 1)),
            "its end is missing: analyse the film again");
}

TEST(MotionFile, WithAWrongByteIsRefusedOrCanBeFelt) {
  const std::string bytes = random_film(4, 60).file();
  std::mt19937 random(4);
  for (size_t i = 0; i < bytes.size(); ++i) {
    for (const int change : {1, 0x80, 1 + static_cast<int>(random() % 255)}) {
      std::string wrong = bytes;
      wrong[i] = static_cast<char>(wrong[i] ^ change);
      refused(wrong);
    }
  }
}

TEST(MotionFile, ATimeThatNoFilmHasIsDamage) {
  for (const int64_t stream_ns : {int64_t{0}, std::numeric_limits<int64_t>::max()}) {
    MotionMoment moment;
    moment.stream_ns = stream_ns;
    MeasuredFrame frame;
    frame.width = 64;
    frame.height = 48;
    MotionFileWriter writer;
    std::string bytes = write_header({});
    writer.add(moment, frame, bytes);
    writer.finish(bytes);
    EXPECT_EQ(refused(bytes), stream_ns == 0 ? "" : "it is damaged: analyse the film again");
  }
}

TEST(MotionFile, SaysWhatIsWrongWithAnother) {
  const std::string none = "it is no analysis of a film";
  for (const std::string& bytes :
       {std::string(), std::string("RIFF and more"), std::string(100000, '\x81'),
        write_cbor({{}, {{"format", "something else"}}, {}})}) {
    EXPECT_EQ(refused(bytes).substr(0, none.size()), none);
  }
  const std::string version = "it has version 7 of the format, and this program reads version 1";
  EXPECT_EQ(refused(write_cbor({{{"version", 7}}, {{"format", "gst-spidar motion"}}, {}}))
                .substr(0, version.size()),
            version);
  // A list inside a list …, as deep as the file is long, is refused where it begins.
  EXPECT_EQ(refused(write_header({}) + std::string(1000000, '\x81')),
            "it is damaged: analyse the film again");
  EXPECT_EQ(refused(write_header({}) + write_cbor({{{"frames", 1'000'000'000'000}}, {}, {}})),
            "it is damaged: analyse the film again");
}

}  // namespace
}  // namespace spidar::test::motion_file_test
