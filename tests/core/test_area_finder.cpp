// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Where the film is in pages, frames and windows of every kind, and that all of a film is found to
// be all of it.
#include <ostream>

#include "core/picture/area_finder.h"
#include "tests/core/screen_scenes.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"

namespace spidar {

void PrintTo(const PicturePart& part, std::ostream* to) {
  *to << part.x << "," << part.y << "," << part.width << "," << part.height;
}

namespace test::screen::area_finder_test {
namespace {

struct Seen {
  std::vector<std::optional<Part>> area;
  std::vector<bool> searches;

  size_t first() const {
    const auto known = [](const std::optional<Part>& part) { return part.has_value(); };
    return static_cast<size_t>(std::find_if(area.begin(), area.end(), known) - area.begin());
  }
};

Seen see(const Scene& scene, int pictures, double noise_grey = 0) {
  AreaFinder finder;
  Picture picture(kWidth, kHeight);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, std::max(noise_grey, 1e-9));
  Seen seen;
  for (int n = 0; n < pictures; ++n) {
    picture.fill([&](double x, double y) {
      return std::clamp(scene(n, x, y) + (noise_grey > 0 ? noise(random) : 0), 0.0, 255.0);
    });
    finder.observe(picture.view(), n * kPicture_ns);
    seen.area.push_back(finder.area());
    seen.searches.push_back(finder.is_searching());
  }
  return seen;
}

/// Sides are found to a pixel of the reduced picture.
bool is_near(const std::optional<Part>& found, const Part& true_part) {
  if (!found) return false;
  const Part& a = *found;
  const Part& b = true_part;
  return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1 &&
         std::abs(a.x + a.width - b.x - b.width) <= 1 &&
         std::abs(a.y + a.height - b.y - b.height) <= 1;
}

/// Found within `most` pictures, and kept.
void expect_found(const Seen& seen, const Part& part, const std::string& what,
                  size_t most = kRate) {
  EXPECT_LE(seen.first(), most) << what;
  for (size_t n = seen.first(); n < seen.area.size(); ++n) {
    ASSERT_TRUE(is_near(seen.area[n], part))
        << what << " " << n << ": " << testing::PrintToString(seen.area[n]);
  }
}

/// All of the picture.
void expect_whole(const Seen& seen, const std::string& what) {
  for (size_t n = 0; n < seen.area.size(); ++n) {
    ASSERT_FALSE(seen.area[n]) << what << " " << n << ": " << testing::PrintToString(*seen.area[n]);
    ASSERT_FALSE(seen.searches[n]) << what << " " << n;
  }
}

const Part kPlaces[] = {
    kMiddle,           {0, 0, 256, 144},  {427 - 171, 240 - 96, 171, 96}, {40, 30, 340, 190},
    {0, 50, 427, 160}, {100, 0, 200, 240}};

TEST(AreaFinder, FindsAFilmWhoseCameraMovesInWhateverRests) {
  const std::vector<std::pair<const char*, Scene>> frames{
      {"page", page},
      {"photograph", [](int, double x, double y) { return kOther.at(x, y); }},
      {"black", [](int, double, double) { return 16.0; }},
      {"blurred", [](int, double x, double y) { return kOther.at(x / 12, y / 12); }}};
  for (const auto& [name, frame] : frames) {
    for (const Part& part : kPlaces) {
      expect_found(see(within(frame, part, pan), kRate + 15), part, name);
    }
  }
}

/// What television makes of a film of an upright telephone, and of one that is wider than it is.
TEST(AreaFinder, FindsAFilmBetweenEnlargedCopiesOfItself) {
  const Sheet detail(5, 2);
  const auto film = [&](int n, double x, double y) { return detail.at(x + 2.2 * n, y + 0.7 * n); };
  const auto enlarged = [&](int n, double x, double y) { return film(n, x / 3.2, y / 3.2); };
  for (const Part& part : {Part{146, 0, 135, 240}, Part{0, 60, 427, 120}}) {
    AreaFinder finder;
    Picture picture(kWidth, kHeight);
    for (int n = 0; n < 2 * kRate; ++n) {
      picture.fill([&](double x, double y) { return within(enlarged, part, film)(n, x, y); });
      finder.observe(picture.view(), n * kPicture_ns);
      if (n == 0) continue;
      ASSERT_TRUE(finder.film()) << n;
      EXPECT_FALSE(finder.is_guess());
      // A side lies between two pixels outside and four inside of the seam.
      for (const auto& [found, seam] :
           {std::pair(finder.film()->x, part.x), std::pair(finder.film()->y, part.y)}) {
        EXPECT_GE(found - seam, seam == 0 ? 0 : -2) << n;
        EXPECT_LE(found - seam, seam == 0 ? 0 : 4) << n;
      }
    }
    // What ends must not leave the film cut.
    for (int n = 2 * kRate; n < 5 * kRate; ++n) {
      picture.fill([&](double x, double y) { return film(n, x, y); });
      finder.observe(picture.view(), n * kPicture_ns);
    }
    EXPECT_FALSE(finder.film());
  }
}

TEST(AreaFinder, FollowsAFilmFromAPageBetweenItsCopiesAndBack) {
  const Sheet detail(5, 2);
  const Part part{146, 0, 135, 240};
  const auto film = [&](int n, double x, double y) { return detail.at(x + 2.2 * n, y + 0.7 * n); };
  const auto enlarged = [&](int n, double x, double y) { return film(n, x / 3.2, y / 3.2); };
  const Scene in_page = within(page, kMiddle, pan);
  const int begins = 2 * kRate, ends = 4 * kRate;
  const Scene scene = then(begins, in_page, then(ends, within(enlarged, part, film), in_page));
  AreaFinder finder;
  Picture picture(kWidth, kHeight);
  for (int n = 0; n < 8 * kRate; ++n) {
    picture.fill([&](double x, double y) { return scene(n, x, y); });
    finder.observe(picture.view(), n * kPicture_ns);
    if (n != begins - 1 && n != ends - 1) continue;
    EXPECT_FALSE(finder.is_searching()) << n;
    ASSERT_TRUE(finder.film()) << n;
    EXPECT_NEAR(finder.film()->x, n < begins ? kMiddle.x : part.x, 4) << n;
  }
  EXPECT_FALSE(finder.is_searching());
  EXPECT_TRUE(is_near(finder.film(), kMiddle)) << testing::PrintToString(finder.film());
}

TEST(AreaFinder, FindsItBesideOtherThingsThatMove) {
  // A ticker, an advertisement, and a box that wanders around the film.
  const auto around = [](int n, double x, double y) {
    if (y >= 222 && y < 232) return page(0, x + 3.0 * n, y);
    if (x >= 350 && x < 420 && y >= 20 && y < 60) return kOther.at(x + 4.0 * n, y);
    const double box_x = std::fmod(5.0 * n, 320);
    if (is_in({static_cast<int>(box_x), 4, 30, 24}, x, y)) return kThing.at(x - box_x, y);
    return page(n, x, y);
  };
  expect_found(see(within(around, kMiddle, pan), 3 * kRate), kMiddle, "busy page");
}

TEST(AreaFinder, TakesAWholeFilmForAllOfThePicture) {
  const std::vector<std::pair<const char*, Scene>> films{
      {"pan", pan},
      {"disc", disc},
      {"nothing", at_rest(pan)},
      {"cut", then(20, disc, pan)},
      {"cut to rest", then(20, pan, disc)},
      {"between bars, which the analysis knows",
       within([](int, double, double) { return 16.0; }, {0, 29, 427, 182}, pan)},
      {"below a plain sky",
       [](int n, double x, double y) { return y < 100 ? 200.0 : pan(n, x, y); }},
      {"hills",
       [](int n, double x, double y) {
         return y < 100 + 20 * std::sin((x + 2.2 * n) / 30) ? 200.0 : pan(n, x, y);
       }},
      {"typing",
       [](int n, double x, double y) { return y < 80 && x < 3 * n ? page(n, x, y) : 240; }},
      {"a clock over a pan", [](int n, double x, double y) {
         return is_in({360, 10, 50, 16}, x, y) ? page(0, x + 13 * (n / 25), y) : pan(n, x, y);
       }}};
  for (const auto& [name, film] : films) {
    expect_whole(see(film, 3 * kRate), name);
    expect_whole(see(film, 2 * kRate, 1), std::string(name) + ", noise");
  }
}

TEST(AreaFinder, KnowsWhatElseScreensShow) {
  const Part map{340, 10, 80, 60}, bar{0, 212, 427, 28}, inset{300, 150, 110, 70};
  const auto other_pan = [](int n, double x, double y) { return kOther.at(x - 1.8 * n, y + n); };
  const auto slides = [](int n, double x, double y) { return page(0, x + 41 * (n / 15), y); };
  const auto terminal = [](int n, double x, double y) {
    const int lines = n / 3, scrolled = std::max(lines - 20, 0);
    return y < 8 * std::min(lines, 20) ? page(0, x, y + 8 * scrolled) : 240;
  };
  /// Of one colour, before a background of which no pixel ever changes; the sky passes.
  const auto cartoon = [](int n, double x, double y) {
    if (std::hypot(x - 60 - 3.0 * (n % 40), y - 90) < 20) return 90.0;
    return y < 40 ? kOther.at(x + n, y) : kWall.at(x, y);
  };
  const struct {
    const char* name;
    Scene scene;
    std::optional<Part> film;
  } cases[] = {
      {"slides", slides, {}},
      {"a speaker before slides", within(slides, inset, other_pan), inset},
      {"a terminal", terminal, {}},
      {"a game with a map and a bar", within(within(pan, map, page), bar, page), {}},
      {"a game in a window", within(page, kMiddle, within(pan, {10, 100, 220, 30}, page)), kMiddle},
      {"a cartoon", cartoon, {}},
      {"a cartoon that pans by whole pixels",
       within(page, kMiddle, [&](int n, double x, double y) { return cartoon(0, x + 2 * n, y); }),
       kMiddle},
      {"a picture in a picture", within(pan, inset, other_pan), {}},
      {"one at rest", within(pan, inset, page), {}},
      {"one in a picture at rest", within(page, inset, other_pan), inset},
      {"two films", within(within(page, {10, 20, 150, 90}, other_pan), {180, 60, 230, 140}, pan),
       Part{180, 60, 230, 140}}};
  for (const auto& [name, scene, film] : cases) {
    const Seen seen = see(scene, 3 * kRate);
    if (film) {
      // Anew when what is around it has changed, and nothing else.
      EXPECT_LE(seen.first(), size_t{kRate}) << name;
      EXPECT_TRUE(is_near(seen.area.back(), *film)) << name;
      for (const std::optional<Part>& area : seen.area) EXPECT_TRUE(!area || is_near(area, *film));
    } else {
      expect_whole(seen, name);
    }
  }
}

TEST(AreaFinder, TakesNoObjectForAFilm) {
  for (const double speed : {0.3, 0.6, 1.0, 2.0, 5.0}) {
    for (const auto& [across, down] : kDirections) {
      const std::string name = std::to_string(speed) + " px a picture, " + std::to_string(across);
      expect_whole(see(square(speed, across, down), 2 * kRate), name);
      expect_whole(see(square(speed, across, down), 2 * kRate, 1), name + ", noise");
    }
  }
}

TEST(AreaFinder, KeepsAFilmWhoseCameraComesToRest) {
  expect_found(see(within(page, kMiddle, then(kRate, pan, disc)), 4 * kRate), kMiddle, "rest");
  // Before the camera moves, there is no area or this one.
  const Seen seen = see(within(page, kMiddle, then(kRate, disc, pan)), 3 * kRate);
  expect_found(seen, kMiddle, "later", 2 * kRate);
}

TEST(AreaFinder, KeepsItBelowANotificationControlsAndSubtitles) {
  const Scene film = within(page, kMiddle, pan);
  const auto covered = [&](const Part& part, double opaque, bool moves) {
    return [=](int n, double x, double y) {
      const double below = film(n, x, y);
      if (n < 30 || n > 90 || !is_in(part, x, y)) return below;
      return (1 - opaque) * below + opaque * page(0, x, y + (moves ? n : 0));
    };
  };
  const std::pair<const char*, Scene> films[] = {
      {"a notification", covered({250, 10, 170, 70}, 1, false)},
      {"controls", covered({90, 165, 240, 20}, 0.6, false)},
      {"subtitles", covered({140, 190, 140, 16}, 1, true)},
      {"a window before it", covered({20, 100, 150, 120}, 1, true)}};
  for (const auto& [name, scene] : films) expect_found(see(scene, 5 * kRate), kMiddle, name);
}

/// From where the page begins to move at `begin` to where it ends, nothing is felt; soon after
/// `end`, the film is known again.
void expect_followed(const Seen& seen, size_t begin, size_t end, const std::optional<Part>& part,
                     const std::string& what) {
  for (size_t n = begin; n <= end; ++n) EXPECT_TRUE(seen.searches[n]) << what << " " << n;
  const size_t known = end + 1 + kRate;  // AreaFinder::kSearch_ns
  for (size_t n = known; n < seen.area.size(); ++n) {
    EXPECT_FALSE(seen.searches[n]) << what << " " << n;
    if (part) {
      EXPECT_TRUE(is_near(seen.area[n], *part))
          << what << " " << n << ": " << testing::PrintToString(seen.area[n]);
    }
    if (!part) {
      EXPECT_FALSE(seen.area[n]) << what << " " << n;
    }
  }
}

TEST(AreaFinder, FollowsAWindowThatMovesAndAFullScreen) {
  const Scene film = within(page, kMiddle, pan);
  const Part theatre{0, 20, 427, 190}, aside{150, 90, 240, 135}, larger{70, 40, 320, 180};
  const int when = 2 * kRate;
  for (const Part& part : {theatre, aside, larger}) {
    expect_followed(see(then(when, film, within(page, part, pan)), 5 * kRate), when, when, part,
                    testing::PrintToString(part));
  }
  expect_followed(see(then(when, film, pan), 5 * kRate), when, when, std::nullopt, "full screen");
}

TEST(AreaFinder, KnowsThatAPageThatScrollsIsNoCamera) {
  const int begin = 2 * kRate, length = 20;
  for (const double step : {2.0, 7.0, 12.0}) {
    const auto down = [=](int n) { return -step * std::clamp(n - begin + 1, 0, length); };
    const Part film{90, 60 + static_cast<int>(step * length) / 4, 240, 135};
    const Scene scene = moved(within(page, film, pan), down);
    Part after = film;
    after.y += static_cast<int>(down(begin + length));
    if (after.y < 0) {
      after.height += after.y;
      after.y = 0;
    }
    const bool is_left = after.height > 60;
    expect_followed(see(scene, 6 * kRate), begin, begin + length - 1,
                    is_left ? std::optional<Part>(after) : std::nullopt, std::to_string(step));
  }
}

/// What looked like a page for a moment may be all of a film whose camera rests.
TEST(AreaFinder, ForgetsAPageThatHasNotScrolledForTwoSeconds) {
  AreaFinder finder;
  Picture picture(kWidth, kHeight);
  constexpr int kScrolls = 10,
                kRests = kScrolls + static_cast<int>(AreaFinder::kRests_ns / kPicture_ns);
  for (int n = 0; n <= kRests + 1; ++n) {
    picture.fill([&](double x, double y) { return disc(n, x, y); });
    finder.observe(picture.view(), n * kPicture_ns, n == kScrolls - 1 || n == kScrolls);
    EXPECT_EQ(finder.is_page(), n >= kScrolls - 1 && n < kRests) << n;
    EXPECT_FALSE(finder.area()) << n;
  }
  EXPECT_FALSE(finder.is_searching());
}

TEST(AreaFinder, StaysWithAFilmUntilItHasRestedForTwoSeconds) {
  const Part second{10, 10, 150, 85}, first{170, 60, 250, 150};
  const auto both = [&](int first_rests) {
    return within(
        within(page, second, [](int n, double x, double y) { return kOther.at(x - 2 * n, y); }),
        first, then(first_rests, pan, at_rest(pan)));
  };
  expect_found(see(both(1000), 3 * kRate), first, "the larger");
  const int rests = 2 * kRate;
  const Seen seen = see(both(rests), 7 * kRate);
  for (size_t n = kRate; n < seen.area.size(); ++n) {
    const bool is_first = n < rests + 2 * kRate;
    const bool is_second = n > rests + 4 * kRate;
    if (is_first) {
      EXPECT_TRUE(is_near(seen.area[n], first)) << n;
    }
    if (is_second) {
      EXPECT_TRUE(is_near(seen.area[n], second)) << n;
    }
  }
}

}  // namespace
}  // namespace test::screen::area_finder_test
}  // namespace spidar
