// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What is burned into a film does not move with a camera that pans: logos, subtitles, clocks, bars,
// a still picture in the picture. It belongs to the screen and is felt by nobody.
#include "core/analysis/motion_analyzer.h"
#include "tests/support/scene_film.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::burned_in_test {
namespace {

using Eigen::Vector2d;

constexpr int kFrames = 30;
/// An object is felt from the second pair of frames on in which it moves.
constexpr int kFelt = 3;
const double kDegree_rad = M_PI / 180;

constexpr double kWhite = 235;
constexpr double kBlack = 16;

/// What is put over a frame after it was taken: the grey level there, given that of the film.
using Caption = std::function<double(int n, const Vector2d& at, double film)>;

const Texture& background() {
  static const Texture texture(1, 10);
  return texture;
}
const Texture& foreground() {
  static const Texture texture(2, 10);
  return texture;
}

bool in_box(const Vector2d& at, double left, double top, double width, double height) {
  return at.x() >= left && at.x() < left + width && at.y() >= top && at.y() < top + height;
}

/// Whether a position is in the stroke of a letter: 5 × 7 cells with gaps of one around them, of
/// which each letter has its own half.
bool in_letter(const Vector2d& at, double cell_px, uint32_t text) {
  const auto i = static_cast<int>(std::floor(at.x() / cell_px));
  const auto j = static_cast<int>(std::floor(at.y() / cell_px));
  if (i < 0 || j < 0 || j >= 7 || i % 6 == 5) return false;
  std::minstd_rand random(text * 7919 + static_cast<uint32_t>(i * 7 + j) * 104729 + 1);
  random.discard(4);
  return random() % 2 == 0;
}

/// Light letters with a dark rim of a pixel and a half, as subtitles have it.
double write(const Vector2d& at, const Vector2d& corner, double width, double cell_px,
             uint32_t text, double film) {
  if (!in_box(at, corner.x() - 2, corner.y() - 2, width + 4, 7 * cell_px + 4)) return film;
  const auto inked = [&](double x, double y) {
    const Vector2d from = at - corner + Vector2d(x, y);
    return from.x() < width && in_letter(from, cell_px, text);
  };
  if (inked(0, 0)) return kWhite;
  for (const double r : {-1.5, 1.5}) {
    if (inked(r, 0) || inked(0, r)) return kBlack;
  }
  return film;
}

struct Burned {
  std::string name;
  Caption caption;
};

double logo(const Vector2d& at, double fraction, double film) {
  if (!in_box(at, 540, 24, 70, 50)) return film;
  const double own =
      (at - Vector2d(575, 49)).norm() < 20 || in_box(at, 545, 60, 60, 8) ? kWhite : 60;
  return fraction * own + (1 - fraction) * film;
}

const std::vector<Burned>& captions() {
  static const std::vector<Burned> all{
      {"Logo", [](int, const Vector2d& at, double film) { return logo(at, 1, film); }},
      {"SemitransparentLogo",
       [](int, const Vector2d& at, double film) { return logo(at, 0.5, film); }},
      {"Subtitles",
       [](int n, const Vector2d& at, double film) {
         // One from the 6th to the 15th frame, another at once after it.
         if (n < 6 || n >= 24) return film;
         return write(at, {140, 310}, 360, 4, n < 15 ? 1 : 2, film);
       }},
      {"Clock",
       [](int n, const Vector2d& at, double film) {
         // The last of its digits changes every tenth frame.
         film = write(at, {40, 30}, 96, 4, 3, film);
         return write(at, {136, 30}, 24, 4, 4 + static_cast<uint32_t>(n) / 10, film);
       }},
      {"Letterbox", [](int, const Vector2d& at,
                       double film) { return at.y() < 45 || at.y() >= 315 ? kBlack : film; }},
      {"HeadUpDisplay",
       [](int n, const Vector2d& at, double film) {
         film = write(at, {20, 320}, 120, 3, 20, film);
         film = write(at, {500, 320}, 120, 3, 21 + static_cast<uint32_t>(n) / 5, film);
         const double from_middle = (at - Vector2d(320, 180)).norm();
         if (std::abs(from_middle - 40) < 1.5) return kWhite;
         if (in_box(at, 20, 20, 150, 14)) return at.x() < 150 - n ? 200.0 : kBlack;
         return film;
       }},
      {"StillPictureInPicture",
       [](int, const Vector2d& at, double film) {
         return in_box(at, 440, 30, 170, 96) ? foreground().at(at.x(), at.y() + 500) : film;
       }},
  };
  return all;
}

/// Frames before anything is put over them.
std::vector<Picture> take(const Scene& scene) {
  std::vector<Picture> film;
  for (int n = 0; n < kFrames; ++n) film.push_back(draw(scene, n));
  return film;
}

std::vector<Frame> analyze(const std::vector<Picture>& film, const Caption& caption = nullptr,
                           MotionKind motion = MotionKind::kObject) {
  AnalyzerSettings settings;
  settings.motion = motion;
  MotionAnalyzer analyzer(settings);
  std::vector<Frame> found;
  Picture picture(kSceneWidth, kSceneHeight);
  for (int n = 0; n < kFrames; ++n) {
    const Picture& taken = film[static_cast<size_t>(n)];
    picture.fill([&](double x, double y) {
      const double grey = *taken.view().at(static_cast<int>(x), static_cast<int>(y));
      return caption ? caption(n, {x, y}, grey) : grey;
    });
    found.push_back(analyzer.analyze(picture.view(), n * kSceneFrame_ns));
  }
  return found;
}

class BurnedIn : public testing::TestWithParam<Burned> {};

TEST_P(BurnedIn, AddsNothingToAPan) {
  static const std::vector<Vector2d> pans{{6, 0}, {-2.5, 0.5}, {1, 4}};
  static const std::vector<std::vector<Picture>> films = [] {
    std::vector<std::vector<Picture>> taken;
    for (const Vector2d& pan : pans) {
      taken.push_back(take([&](int n, const Vector2d& at) {
        const Vector2d from = at + n * pan;
        return background().at(from.x(), from.y());
      }));
    }
    return taken;
  }();
  for (size_t k = 0; k < films.size(); ++k) {
    SCOPED_TRACE(testing::Message() << "pan of " << pans[k].transpose() << " px a frame");
    const std::vector<Frame> found = analyze(films[k], GetParam().caption);
    for (int n = 0; n < kFrames; ++n) {
      const Vector2d moved_px = found[static_cast<size_t>(n)].motion.velocity_px_s * kSceneFrame_s;
      EXPECT_EQ(moved_px, Vector2d(0, 0)) << "frame " << n;
    }
  }
}

TEST(BurnedInLines, DoNotSayHowTheCameraMoves) {
  // A faint scene and bold letters that come line by line, as titles do: all together they have
  // more texture than the scene.
  const Vector2d pan(1, 4);
  const std::vector<Picture> film = take([&](int n, const Vector2d& at) {
    const Vector2d from = at + n * pan;
    return 128 + 0.7 * (background().at(from.x(), from.y()) - 128);
  });
  const Caption lines = [](int n, const Vector2d& at, double grey) {
    for (int line = 0; line < n / 4; ++line) {
      grey = write(at, {60, 320.0 - 40 * line}, 520, 4, static_cast<uint32_t>(line), grey);
    }
    return grey;
  };
  const std::vector<Frame> found = analyze(film, lines, MotionKind::kCamera);
  // Blocks are right to a tenth of a pixel of the field, which is 1.5 of the frame's.
  constexpr double kError_px = 0.15;
  for (int n = 1; n < kFrames; ++n) {
    const Vector2d moved_px = found[static_cast<size_t>(n)].motion.velocity_px_s * kSceneFrame_s;
    EXPECT_LT((moved_px - pan).norm(), kError_px) << "frame " << n;
  }
}

TEST(BurnedInFrames, AreNoSceneInWhichTheCameraRests) {
  // A camera travels past a scene with depth, of which no model explains more than a part. A frame
  // of bold letters lies at the border, where votes for the camera's motion count twice.
  const std::vector<Picture> film = take([](int n, const Vector2d& at) {
    const double nearness = 1 + std::floor(at.y() / 60) / 5;
    const Vector2d from = at + n * nearness * Vector2d(3, 1.5);
    return background().at(from.x(), from.y());
  });
  const Caption frame = [](int, const Vector2d& at, double grey) {
    grey = write(at, {16, 10}, 608, 4, 1, grey);
    grey = write(at, {16, 322}, 608, 4, 2, grey);
    for (uint32_t line = 0; line < 6; ++line) {
      grey = write(at, {16, 60.0 + 40 * line}, 24, 4, 10 + line, grey);
      grey = write(at, {600, 60.0 + 40 * line}, 24, 4, 20 + line, grey);
    }
    return grey;
  };
  const std::vector<Frame> found = analyze(film, frame, MotionKind::kCamera);
  for (size_t n = 1; n < kFrames; ++n) {
    // Nothing of the scene moves by less than the furthest part, hypot(3, 1.5) px.
    EXPECT_GT(found[n].motion.velocity_px_s.norm() * kSceneFrame_s, 1) << "frame " << n;
  }
}

TEST(BurnedInLetters, AreSeenThroughInTheQuietPartOfANoisyFilm) {
  // A dark sky above grass that boils. By the noise of the grass, the half-transparent letters in
  // the sky would be an object that the camera follows.
  const Vector2d pan(5, -3);
  const std::vector<Picture> film = take([&](int n, const Vector2d& at) {
    const Vector2d from = at + n * pan;
    const double grey = background().at(from.x(), from.y());
    if (at.y() < 90) return 50 + 0.65 * (grey - 128);
    return grey + 0.18 * (foreground().at(at.x() + 83.0 * n, at.y() + 47.0 * n) - 128);
  });
  const Caption letters = [](int, const Vector2d& at, double grey) {
    return grey + 0.5 * (write(at, {480, 20}, 96, 4, 1, grey) - grey);
  };
  const std::vector<Frame> found = analyze(film, letters);
  for (size_t n = 0; n < kFrames; ++n)
    EXPECT_EQ(found[n].motion.velocity_px_s, Vector2d(0, 0)) << "frame " << n;
}

const Caption& subtitles() {
  return captions()[2].caption;
}

TEST(BurnedInSubtitles, DoNotMakeAnObjectOfANearLayer) {
  // It reaches beyond the lower border, which the subtitle hides.
  const auto shown = [](int n, const Vector2d& at) {
    const double left = 340 - 9.0 * n;
    if (in_box(at, left, 265, 300, 95)) return foreground().at(at.x() - left, at.y());
    return background().at(at.x() + 2.0 * n, at.y());
  };
  const std::vector<Picture> film = take(shown);
  for (const bool with : {false, true}) {
    const std::vector<Frame> found = analyze(film, with ? subtitles() : nullptr);
    for (size_t n = 0; n < kFrames; ++n) {
      EXPECT_EQ(found[n].motion.velocity_px_s, Vector2d(0, 0))
          << "frame " << n << (with ? " with the subtitle" : "");
    }
  }
}

/// As strong as without the caption to 10 % and in that direction to 15°, over the film; and always
/// felt about that way.
void expect_plain(const std::vector<Picture>& film, const std::vector<Frame>& plain,
                  const Caption& caption) {
  const std::vector<Frame> found = analyze(film, caption);
  double ff = 0;
  double pp = 0;
  double fp = 0;
  for (size_t n = kFelt; n < kFrames; ++n) {
    const Vector2d& f = found[n].motion.velocity_px_s;
    const Vector2d& p = plain[n].motion.velocity_px_s;
    ASSERT_GT(p.norm(), 0) << "frame " << n;
    EXPECT_GT(f.dot(p), std::cos(30 * kDegree_rad) * f.norm() * p.norm()) << "frame " << n;
    ff += f.squaredNorm();
    pp += p.squaredNorm();
    fp += f.dot(p);
  }
  EXPECT_NEAR(std::sqrt(ff / pp), 1, 0.1);
  EXPECT_GT(fp / std::sqrt(ff * pp), std::cos(15 * kDegree_rad));
}

TEST_P(BurnedIn, LeavesAnObjectInFrontOfAPanAsItIs) {
  static const std::vector<Picture> film = take([](int n, const Vector2d& at) {
    const Vector2d middle(200.0 + 4 * n, 190);
    if ((at - middle).norm() < 55) return foreground().at(at.x() - 4.0 * n, at.y());
    return background().at(at.x() + 4.0 * n, at.y());
  });
  static const std::vector<Frame> plain = analyze(film);
  expect_plain(film, plain, GetParam().caption);
}

TEST_P(BurnedIn, LeavesWhatTheCameraFollowsAsItIs) {
  // It stays where it is on the screen, to the last fraction of a pixel: only the film's noise
  // tells it from a logo.
  static const std::vector<Picture> film = take([](int n, const Vector2d& at) {
    if ((at - Vector2d(330, 200)).norm() < 55) return foreground().at(at.x(), at.y());
    return background().at(at.x() + 7.0 * n, at.y() + 1.0 * n);
  });
  static const std::vector<Frame> plain = analyze(film);
  expect_plain(film, plain, GetParam().caption);
}

TEST(BurnedInSubtitles, LeaveAnObjectBehindThemAsItIs) {
  const std::vector<Picture> film = take([](int n, const Vector2d& at) {
    const Vector2d middle(200.0 + 4 * n, 270);
    if ((at - middle).norm() < 70) return foreground().at(at.x() - 4.0 * n, at.y());
    return background().at(at.x() + 4.0 * n, at.y());
  });
  expect_plain(film, analyze(film), subtitles());
}

INSTANTIATE_TEST_SUITE_P(Captions, BurnedIn, testing::ValuesIn(captions()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace spidar::test::burned_in_test
