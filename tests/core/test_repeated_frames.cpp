// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Films whose frames repeat pictures are felt like the plain film: 24 pictures a second in 25, 30
// and 60 frames, five in six frames (as 25 in 30 are), drawn on twos and threes, with late frames;
// in a player, which knows the next frames, and live. A picture at rest gives no force.
#include "tests/support/felt_film.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::repeated_frames_test {
namespace {

using test::compare_felt;
using test::feel;
using test::FeltDifference;
using test::MovingScene;
using test::Picture;
using test::ShownFrame;

constexpr int kPictures = 72;
constexpr double kPicture_Hz = 24;
constexpr int64_t kAhead_ns = 150'000'000;  // a queue of a few frames
/// By then the rhythm is known.
constexpr size_t kLearnt_ms = 700;
const double kDegree_rad = M_PI / 180;

/// Something that circles in front of a still background, 0.4 times a second, and has 8 % of the
/// picture.
const std::vector<Picture>& circling() {
  static const std::vector<Picture> pictures = [] {
    constexpr int kWidth = 480, kHeight = 270;
    MovingScene scene(kWidth, kHeight);
    scene.add_disc(std::sqrt(0.08 * kWidth * kHeight / M_PI));
    std::vector<Picture> drawn;
    for (int n = 0; n < kPictures; ++n) {
      const double angle = 360 * kDegree_rad * 0.4 * n / kPicture_Hz;
      // A copy, because the scene reuses its memory.
      const ImageView view = scene.draw({}, {{{90 * std::cos(angle), 60 * std::sin(angle)}}});
      drawn.emplace_back(kWidth, kHeight);
      drawn.back().pixels.assign(view.data, view.data + kWidth * kHeight);
    }
    return drawn;
  }();
  return pictures;
}

/// A film made of some pictures that were taken 24 times a second.
struct Variant {
  std::string name;
  double frame_Hz;
  std::function<int(int frame)> picture;
  int drawn_for = 1;  ///< frames, where there are only so many different pictures
};

std::vector<Variant> variants() {
  const auto pulled_down = [](double frame_Hz) {
    return [frame_Hz](int n) { return static_cast<int>(n * kPicture_Hz / frame_Hz + 1e-9); };
  };
  return {{"24 in 60", 60, pulled_down(60)},
          {"24 in 50", 50, pulled_down(50)},
          {"24 in 30", 30, pulled_down(30)},
          {"24 in 25", 25, pulled_down(25)},
          {"five in six", 28.8, pulled_down(28.8)},
          {"on twos", 24, [](int n) { return n / 2 * 2; }, 2},
          {"on threes", 24, [](int n) { return n / 3 * 3; }, 3},
          {"lost now and then", 24, [](int n) { return n % 11 == 7 ? n - 1 : n; }}};
}

const Variant kPlain{"plain", 24, [](int n) { return n; }};

std::string name_of(const testing::TestParamInfo<Variant>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

/// Its frames as long as there are pictures, with `still` frames more that show the last one.
std::vector<ShownFrame> frames_of(const Variant& variant, const std::vector<Picture>& pictures,
                                  int still = 0) {
  std::vector<ShownFrame> frames;
  int n = 0;
  const auto show = [&](const Picture* picture) {
    const bool again = !frames.empty() && frames.back().picture == picture;
    frames.push_back({std::llround(1e9 * n++ / variant.frame_Hz), picture, again});
  };
  while (variant.picture(n) < static_cast<int>(pictures.size())) {
    show(&pictures[static_cast<size_t>(variant.picture(n))]);
  }
  for (int i = 0; i < still; ++i) show(frames.back().picture);
  return frames;
}

/// Repeated frames are not flagged, so all are analysed.
std::vector<ShownFrame> unflagged(std::vector<ShownFrame> frames) {
  for (ShownFrame& frame : frames) frame.flagged = false;
  return frames;
}

class RepeatedFrames : public testing::TestWithParam<Variant> {
 protected:
  static void expect_plain(const std::vector<ShownFrame>& frames) {
    for (const int64_t ahead_ns : {kAhead_ns, int64_t{0}}) {
      SCOPED_TRACE(ahead_ns > 0 ? "player" : "live");
      const auto plain = feel(unflagged(frames_of(kPlain, circling())), ahead_ns);
      const FeltDifference difference = compare_felt(feel(frames, ahead_ns), plain, kLearnt_ms);
      EXPECT_NEAR(difference.strength, 1, 0.1);
      EXPECT_LT(difference.angle_rad, 15 * kDegree_rad);
      EXPECT_LT(difference.steps, 1.5);
    }
  }
};

TEST_P(RepeatedFrames, AreFeltAsThePlainFilm) {
  expect_plain(unflagged(frames_of(GetParam(), circling())));
}

TEST_P(RepeatedFrames, ThatAreFlaggedAreFeltAsThePlainFilm) {
  expect_plain(frames_of(GetParam(), circling()));
}

TEST_P(RepeatedFrames, AreRestWhenTheyDoNotEnd) {
  constexpr int kStill = 30;
  for (const int64_t ahead_ns : {kAhead_ns, int64_t{0}}) {
    SCOPED_TRACE(ahead_ns > 0 ? "player" : "live");
    const auto frames = frames_of(GetParam(), circling(), kStill);
    size_t last = frames.size() - 1;
    while (frames[last].picture == frames.back().picture) --last;
    const double changed_ms = 1e-6 * static_cast<double>(frames[last + 1].time_ns);
    // Or a frame, and the time of fading, after the next picture was due.
    const double frame_ms = 1e3 / GetParam().frame_Hz;
    const double rest_ms = std::max(100.0, (GetParam().drawn_for + 1) * frame_ms + 15);
    for (const auto& shown : {frames, unflagged(frames)}) {
      const auto force_N = feel(shown, ahead_ns);
      const auto rest = static_cast<size_t>(std::ceil(changed_ms + rest_ms));
      EXPECT_GT(force_N[static_cast<size_t>(changed_ms)].norm(), 0.1);
      for (size_t ms = rest; ms < force_N.size(); ++ms) ASSERT_EQ(force_N[ms].norm(), 0) << ms;
    }
  }
}

// Before, a force that began after a picture without any took only the last of its frames to rise.
TEST(DrawingsOnTwos, AreFeltAsTheFilmOfTheirPictures) {
  const auto drawn = [](int n) { return n / 2 * 2; };
  const Variant twos{"on twos", 24, drawn},
      pictures{"12 a second", 12, [](int n) { return 2 * n; }};
  const auto felt_N = feel(unflagged(frames_of(twos, circling())), kAhead_ns);
  const auto plain_N = feel(frames_of(pictures, circling()), kAhead_ns);
  EXPECT_GT(plain_N.back().norm(), 0.1);
  // An interval is rounded to a nanosecond, of 83 ms; the force is less than 3 N.
  constexpr double kRounding_N = 3 * 2e-9 * 12;
  // The end of the film is known in one of them only.
  for (size_t ms = 0; ms + 200 < std::min(felt_N.size(), plain_N.size()); ++ms)
    ASSERT_LE((felt_N[ms] - plain_N[ms]).norm(), kRounding_N) << ms;
}

INSTANTIATE_TEST_SUITE_P(Films, RepeatedFrames, testing::ValuesIn(variants()), name_of);

/// What an encoder adds differs from frame to frame, also where the picture does not.
class Coded {
 public:
  /// Adds up to so many grey levels, or takes them away.
  explicit Coded(int noise_grey = 3) : noise_grey_(noise_grey) {}

  /// The frames of `variant`, not flagged, until the next call for another one.
  std::vector<ShownFrame> frames(const Variant& variant) {
    std::vector<ShownFrame> frames = unflagged(frames_of(variant, circling()));
    pictures_.clear();
    for (const ShownFrame& frame : frames) pictures_.push_back(with_noise(*frame.picture));
    for (size_t i = 0; i < frames.size(); ++i) frames[i].picture = &pictures_[i];
    return frames;
  }

 private:
  Picture with_noise(const Picture& picture) {
    Picture noisy = picture;
    for (uint8_t& level : noisy.pixels) {
      const auto values = static_cast<unsigned>(2 * noise_grey_ + 1);
      const int value = level + static_cast<int>(random_() % values) - noise_grey_;
      level = static_cast<uint8_t>(std::clamp(value, 0, 255));
    }
    return noisy;
  }

  int noise_grey_;
  std::mt19937 random_{1};
  std::vector<Picture> pictures_;
};

// Neither of the two is taken for rest.
TEST(CodedRepeats, AreFeltAsThePlainFilmAfterTheSecondOne) {
  constexpr int kLittle_grey = 1;  // as good encoders leave
  constexpr int kLast = 11;        // frame of the second repetition, of 24 in 30 after a motion
  for (const Variant& variant : variants()) {
    if (variant.name != "24 in 60" && variant.name != "24 in 30" && variant.name != "on twos") {
      continue;
    }
    SCOPED_TRACE(variant.name);
    Coded coded(kLittle_grey), plain(kLittle_grey);
    const double from_s = (kLast + 1) / variant.frame_Hz;
    const auto from_ms = static_cast<size_t>(1e3 * from_s + 1e-6 * WrenchTimeline::kLatest_ns);
    const FeltDifference difference = compare_felt(feel(coded.frames(variant), kAhead_ns),
                                                   feel(plain.frames(kPlain), kAhead_ns), from_ms);
    EXPECT_NEAR(difference.strength, 1, 0.05);
    EXPECT_LT(difference.angle_rad, 15 * kDegree_rad);
    EXPECT_LT(difference.steps, 1.5);
  }
}

TEST(CodedRepeats, AreFeltAsThePlainFilm) {
  Coded coded, plain_coded;
  for (const Variant& variant : variants()) {
    if (variant.name != "24 in 60" && variant.name != "24 in 30" && variant.name != "on twos") {
      continue;
    }
    SCOPED_TRACE(variant.name);
    const FeltDifference difference =
        compare_felt(feel(coded.frames(variant), kAhead_ns),
                     feel(plain_coded.frames(kPlain), kAhead_ns), kLearnt_ms);
    EXPECT_NEAR(difference.strength, 1, 0.1);
    EXPECT_LT(difference.angle_rad, 15 * kDegree_rad);
    EXPECT_LT(difference.steps, 1.5);
  }
}

// Before, the interval was learnt from what the first repetitions had cut in pieces, and the force
// of drawings on twos began at twice its size and came down in four steps.
TEST(CodedRepeats, AreAsStrongAsThePlainFilmFromTheirRecognitionOn) {
  // Two dips have ended with the sixth frame, the seventh is recognised, and the force of the
  // eighth is reached kLatest_ns later.
  constexpr double kFrame_ms = 1e3 / kPicture_Hz;
  const auto from_ms =
      static_cast<std::ptrdiff_t>(8 * kFrame_ms + 1e-6 * WrenchTimeline::kLatest_ns);
  const auto largest_N = [&](const std::vector<Eigen::Vector3d>& force_N) {
    double largest = 0;
    for (auto at = force_N.begin() + from_ms; at != force_N.end(); ++at)
      largest = std::max(largest, at->norm());
    return largest;
  };
  const std::vector<Variant> all = variants();
  const auto twos = std::find_if(all.begin(), all.end(),
                                 [](const Variant& each) { return each.name == "on twos"; });
  Coded coded, plain;
  const double plain_N = largest_N(feel(plain.frames(kPlain), 0));
  EXPECT_NEAR(largest_N(feel(coded.frames(*twos), 0)) / plain_N, 1, 0.1);
}

}  // namespace
}  // namespace spidar::test::repeated_frames_test
