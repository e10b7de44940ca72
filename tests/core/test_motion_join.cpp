// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Pieces of a film that were measured by themselves make what one run would have made, bit by bit.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/analysis/frame_meter.h"
#include "core/analysis/motion_join.h"
#include "core/analysis/piece_end.h"
#include "tests/core/motion_rows.h"
#include "tests/support/picture.h"
#include "tests/support/texture.h"

namespace spidar::test::motion_join_test {
namespace {

using Eigen::Vector2d;

constexpr int kFilmFrames = 240;
constexpr int kSceneFrames = 40;
constexpr int kWidth = 320;
constexpr int kHeight = 180;

/// In every scene a disc crosses another background, which goes elsewhere. In every third scene
/// each picture is shown twice; the frame after a cut also repeats it.
double grey(int n, const Vector2d& at) {
  const int scene = n / kSceneFrames;
  int k = n % kSceneFrames;
  if (scene % 3 == 2 || k == 1) k -= k % 2;
  const auto seed = static_cast<uint32_t>(10 * scene);
  const Vector2d centre(60 + 5 * k, 90 + 20 * (scene % 2));
  const Vector2d on = at - centre;
  if (on.norm() < 36) return Texture(seed + 1, 6).at(on.x(), on.y());
  return Texture(seed + 2, 8).at(at.x() + (scene % 4 - 1) * k, at.y());
}

/// What a run measures of the frames from `first` to before `end`.
MotionFile measured(int first, int end, const MotionPiece& piece, int points = 64) {
  static const std::vector<Picture> film = [] {
    std::vector<Picture> pictures;
    for (int n = 0; n < kFilmFrames; ++n) {
      pictures.emplace_back(kWidth, kHeight);
      pictures.back().fill([&](double x, double y) { return grey(n, {x, y}); });
    }
    return pictures;
  }();
  FrameMeter::Settings settings;
  settings.tracker.max_features = points;
  FrameMeter meter(settings);
  MotionFileWriter writer;
  MotionHeader header{"film", "", false, piece};
  header.piece.has_end = end == kFilmFrames;
  std::string bytes = write_header(header);
  for (int n = first; n < end; ++n) {
    const int64_t time_ns = n * kMeasuredFrame_ns;
    const MeasuredFrame& found = meter.measure(film[static_cast<size_t>(n)].view(), time_ns);
    writer.add({MomentKind::kFrame, time_ns, kMeasuredFrame_ns, false, {}}, found, bytes);
  }
  writer.finish(bytes);
  return read_motion(bytes);
}

MotionPiece piece(int number, int of) {
  return {number, of, kFilmFrames * kMeasuredFrame_ns, false, "1.0", ""};
}

std::string joined(const std::vector<MotionFile>& files) {
  MotionJoin join;
  for (const MotionFile& file : files) join.add(file);
  return join.whole();
}

std::string refused(const std::vector<MotionFile>& files) {
  try {
    joined(files);
  } catch (const MotionFileError& error) {
    return error.what();
  }
  return {};
}

/// What one run measures.
const std::string& whole() {
  static const std::string bytes = joined({measured(0, kFilmFrames, piece(1, 1))});
  return bytes;
}

TEST(MotionJoin, OfOnePieceIsThatPiece) {
  const MotionFile file = measured(0, kFilmFrames, {});
  const MotionFile again = read_motion(whole());
  ASSERT_EQ(again.size(), file.size());
  EXPECT_EQ(again.header().piece.of, 0);
  size_t objects = 0;
  for (size_t i = 0; i < file.size(); ++i) objects += file.objects(i).size();
  EXPECT_GT(objects, file.size() / 2);  // there is something to be joined
}

TEST(MotionJoin, LeavesNoTraceOfWhereAPieceBegan) {
  for (int begin = 42; begin < 52; ++begin) {
    // The second piece has seen another past, or none, and has given out fewer ids.
    for (const int end : {121, 130, 170}) {
      SCOPED_TRACE(std::to_string(begin) + " " + std::to_string(end));
      EXPECT_TRUE(joined({measured(0, end, piece(1, 2)),
                          measured(begin, kFilmFrames, piece(2, 2))}) == whole());
    }
  }
  EXPECT_TRUE(joined({measured(0, 90, piece(1, 4)), measured(45, 165, piece(2, 4)),
                      measured(83, 170, piece(3, 4)), measured(122, kFilmFrames, piece(4, 4))}) ==
              whole());
}

TEST(MotionJoin, SkipsAPieceThatTheOneBeforeGoesBeyond) {
  EXPECT_TRUE(joined({measured(0, 170, piece(1, 3)), measured(45, 70, piece(2, 3)),
                      measured(122, kFilmFrames, piece(3, 3))}) == whole());
  EXPECT_TRUE(joined({measured(0, kFilmFrames, piece(1, 2)),
                      measured(122, kFilmFrames, piece(2, 2))}) == whole());
}

TEST(MotionJoin, NeedsACutBehindACommonPast) {
  // No cut in what both have seen; a gap; one cut, six frames after the second began.
  EXPECT_NE(refused({measured(0, 78, piece(1, 2)), measured(45, kFilmFrames, piece(2, 2))})
                .find("no cut makes them equal"),
            std::string::npos);
  EXPECT_EQ(refused({measured(0, 50, piece(1, 2)), measured(60, kFilmFrames, piece(2, 2))}),
            "piece 2 of 2 begins at 2.40 s, and what is before it ends at 1.96 s");
  EXPECT_NE(refused({measured(0, 100, piece(1, 2)), measured(74, kFilmFrames, piece(2, 2))}), "");
}

TEST(MotionJoin, RefusesPiecesThatDoNotBelongTogether) {
  const auto with = [](MotionPiece other, const auto& change) {
    change(other);
    return measured(45, kFilmFrames, other);
  };
  const MotionFile first = measured(0, 130, piece(1, 2));
  EXPECT_EQ(refused({first}), "piece 2 of 2 is missing");
  EXPECT_EQ(refused({measured(45, 100, piece(2, 2))}),
            "it is piece 2 of 2, and piece 1 is missing");
  EXPECT_EQ(refused({first, with(piece(2, 3), [](MotionPiece&) {})}),
            "it is piece 2 of 3, and the one before is piece 1 of 2");
  EXPECT_EQ(refused({first, with(piece(2, 2), [](MotionPiece& p) { p.program = "2.0"; })}),
            "it was measured by version 2.0, and piece 1 by version 1.0");
  EXPECT_EQ(refused({first, with(piece(2, 2), [](MotionPiece& p) { p.film_ns += 1'000'000'000; })}),
            "the film was 10.60 s long, and for piece 1 it was 9.60 s: measure all pieces of the "
            "film as it is now");
  EXPECT_EQ(refused({first, with(piece(2, 2), [](MotionPiece& p) { p.format = "wav"; })}),
            "it was measured with the defaults for wav, and piece 1 with the defaults");
  EXPECT_EQ(refused({measured(0, kFilmFrames, {})}),
            "it is the analysis of a whole film, and there is nothing to join");
  // It says that it was measured in the same way.
  EXPECT_NE(refused({first, measured(45, kFilmFrames, piece(2, 2), 2)})
                .find("piece 2 of 2 differs from the one before"),
            std::string::npos);
}

TEST(PieceEnd, IsAtTheSecondCutAfterWhichBothFindTheSame) {
  PieceEnd end(piece(1, 2));  // the second piece begins with frame 120
  const auto take = [&](int n, bool is_cut, bool agrees) {
    return end.take(is_cut ? Shown::kFirst : Shown::kOther, n * kMeasuredFrame_ns, agrees);
  };
  for (int n = 0; n < 130; ++n) EXPECT_FALSE(take(n, n % 20 == 0, n < 120)) << n;
  // From frame 130 on, both agree. 24 intervals later the past is common.
  for (int n = 130; n < 190; ++n) EXPECT_FALSE(take(n, n == 140 || n == 170, true)) << n;
  EXPECT_TRUE(take(190, true, true));
}

TEST(PieceEnd, OfAPieceWithoutCutsIsItsOwnEnd) {
  PieceEnd end(piece(2, 4));  // frames 60 to 119
  for (int n = 60; n < 120; ++n) {
    EXPECT_FALSE(end.take(n == 115 ? Shown::kFirst : Shown::kOther, n * kMeasuredFrame_ns, true));
  }
  EXPECT_TRUE(end.is_empty());
  EXPECT_TRUE(end.take(Shown::kOther, 120 * kMeasuredFrame_ns, true));
}

}  // namespace
}  // namespace spidar::test::motion_join_test
