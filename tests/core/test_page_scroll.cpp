// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A page that scrolls is no camera, and a camera is no page that scrolls.
#include "core/analysis/motion_analyzer.h"
#include "core/picture/page_scroll.h"
#include "tests/support/coded_film.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::page_scroll_test {
namespace {

constexpr int kWidth = 854, kHeight = 480;
constexpr int64_t kPicture_ns = 20'000'000;
const Texture kWords(3, 3), kWall(1, 20), kThing(2, 16);

/// Grey level of picture n at a position.
using Scene = std::function<double(int n, double x, double y)>;

/// Lines of words.
double page(double x, double y) {
  const double line = std::floor(y / 20);
  if (y - 20 * line < 8 || std::fmod(x + 29 * line + 1e4, 67) < 9) return 250;
  return kWords.at(x, y) > 128 ? 30 : 250;
}

/// The same, scrolled by `step` px a picture from picture `begin` on.
Scene scrolled(int step, int begin = 1) {
  return [=](int n, double x, double y) { return page(x, y + step * std::max(n - begin + 1, 0)); };
}

double page_at_rest(int, double x, double y) {
  return page(x, y + 1e3);
}

/// In a part of the picture, `inside`; around it, `around`.
Scene within(const Scene& around, const PicturePart& part, const Scene& inside) {
  return [=](int n, double x, double y) {
    const bool is_in =
        x >= part.x && y >= part.y && x < part.x + part.width && y < part.y + part.height;
    return (is_in ? inside : around)(n, x, y);
  };
}

/// With the noise of a camera.
Scene noisy(const Scene& scene) {
  return [scene, random = std::mt19937(1), noise = std::normal_distribution<double>(0, 1)](
             int n, double x, double y) mutable {
    return std::clamp(scene(n, x, y) + noise(random), 0.0, 255.0);
  };
}

double pan(int n, double x, double y) {
  return kWall.at(x, y + 5.0 * n);
}

double desktop(int, double x, double y) {
  return kWall.at(x, y + 3000);
}

std::vector<Picture> drawn(const Scene& scene, int pictures) {
  std::vector<Picture> drawn(static_cast<size_t>(pictures), Picture(kWidth, kHeight));
  for (int n = 0; n < pictures; ++n) {
    drawn[static_cast<size_t>(n)].fill([&](double x, double y) { return scene(n, x, y); });
  }
  return drawn;
}

int scrolls_of(const std::vector<Picture>& pictures) {
  PageScroll scroll;
  return static_cast<int>(std::count_if(pictures.begin(), pictures.end(), [&](const Picture& seen) {
    return scroll.update(seen.view());
  }));
}

constexpr PicturePart kFilm{200, 90, 500, 280}, kBelowToolbar{0, 80, kWidth, kHeight - 80},
    kWindow{300, 60, 420, 360};

TEST(PageScroll, IsSeenInEachPicture) {
  constexpr int kPictures = 3;
  for (const int step : {1, 20, 64, -110}) {
    const Scene all = scrolled(step);
    for (const auto& [name, scene] : {std::pair<const char*, Scene>{"a page", all},
                                      {"below a toolbar", within(page_at_rest, kBelowToolbar, all)},
                                      {"in a window", within(desktop, kWindow, all)},
                                      {"with a film", within(all, kFilm, noisy(pan))}}) {
      EXPECT_EQ(scrolls_of(drawn(scene, kPictures)), kPictures - 1) << name << " by " << step;
    }
  }
}

TEST(PageScroll, IsNoneOfWhatElseMoves) {
  const auto disc = [](int n, double x, double y) {
    const double at_y = y - 60 - 9.0 * n;
    return std::hypot(x - 400, at_y) < 60 ? kThing.at(x, at_y) : desktop(0, x, y);
  };
  const auto sideways = [](int n, double x, double y) { return page(x + 6.0 * n, y); };
  const auto bars = [](int n, double, double y) {
    return std::fmod(y + 7.0 * n, 120) < 60 ? 200.0 : 40.0;
  };
  const auto fractions = [](int n, double x, double y) { return page(x, y + 4.5 * n); };
  const auto clean = [](int n, double x, double y) {
    return kWall.at(x + 3.0 * ((n + 1) / 2), y + 4.0 * (n / 2));
  };
  for (const auto& [name, scene] : {std::pair<const char*, Scene>{"a page at rest", scrolled(0)},
                                    {"a camera without noise, right and down in turn", clean},
                                    {"a camera", noisy(pan)},
                                    {"an object", disc},
                                    {"plain bars", bars},
                                    {"a page that moves sideways", sideways},
                                    {"by half a pixel", fractions}}) {
    EXPECT_EQ(scrolls_of(drawn(scene, 4)), 0) << name;
  }
}

/// Of one that pans by whole pixels without any noise, a few pictures may pass for a page.
TEST(PageScroll, IsNoFilmThatHasBeenCoded) {
  for (const double noise_grey : {0.5, 2.0}) {
    CodedFilm film;
    film.wall = CodedFilm::Wall::kMeadow;
    film.coding = kX264.options;
    film.pan_px = {0, 4};
    film.noise_grey = noise_grey;
    const std::vector<Picture> pictures = film.pictures();
    if (pictures.empty()) GTEST_SKIP() << "ffmpeg has no " << kX264.name;
    EXPECT_EQ(scrolls_of(pictures), 0) << noise_grey;
  }
}

/// From the first to the last picture of a page that scrolls for more than a second, with nothing
/// at rest beside it or a toolbar, and the rest that follows.
TEST(PageScroll, IsNotFelt) {
  constexpr int kBegin = 10, kEnd = kBegin + 60, kPictures = kEnd + 10;
  const auto until = [=](int n, double x, double y) {
    return scrolled(11, kBegin)(std::min(n, kEnd), x, y);
  };
  for (const auto& [name, scene] : {std::pair<const char*, Scene>{"a page", until},
                                    {"below a toolbar", within(page_at_rest, kBelowToolbar, until)},
                                    {"in a window", within(desktop, kWindow, until)}}) {
    AnalyzerSettings settings;
    settings.area.kind = AreaSetting::Kind::kAuto;
    MotionAnalyzer analyzer(settings);
    Picture picture(kWidth, kHeight);
    for (int n = 0; n < kPictures; ++n) {
      picture.fill([n, &draw = scene](double x, double y) { return draw(n, x, y); });
      const Frame& frame = analyzer.analyze(picture.view(), n * kPicture_ns);
      ASSERT_TRUE(frame.wrench.stacked().isZero(0)) << name << " " << n;
      if (n >= kBegin) {
        ASSERT_TRUE(frame.place.is_page) << name << " " << n;
      }
    }
  }
}

}  // namespace
}  // namespace spidar::test::page_scroll_test
