// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The film in a part of the picture: it is felt as if it were alone, and shown where it is.
#include "plugin/frame/object_metas.h"
#include "plugin/properties/motion_properties.h"
#include "tests/support/element_harness.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"
#include "tests/support/video_frames.h"

namespace spidar::test::area_test {
namespace {

using Eigen::Vector2d;

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr PicturePart kFilm{160, 60, 480, 270};
constexpr int kWidth = 800, kHeight = 450;
constexpr int kFrames = 8;
/// Where a disc is in the first frame, from the middle of the film.
const Vector2d kFirst_px(-60, 0);

/// Two discs before a camera that pans, in a picture that goes elsewhere.
class Films {
 public:
  Films() {
    scene_.add_disc(30);
    scene_.add_disc(25);
  }

  /// Frame n of the film alone.
  ImageView film(int n) {
    return scene_.draw({Vector2d(2, 1) * n},
                       {{kFirst_px + Vector2d(5, 1) * n}, {{120, 60 - 4.0 * n}}});
  }
  /// The same within the picture around it.
  GstBuffer* picture(int n, const GstVideoInfo& info) {
    const ImageView inside = film(n);
    return make_picture(info, [&](int x, int y) -> double {
      const int film_x = x - kFilm.x, film_y = y - kFilm.y;
      if (film_x < 0 || film_y < 0 || film_x >= kFilm.width || film_y >= kFilm.height) {
        return std::floor(around_.at(x - 7.0 * n, y));
      }
      return *inside.at(film_x, film_y);
    });
  }
  GstBuffer* alone(int n, const GstVideoInfo& info) {
    const ImageView inside = film(n);
    return make_picture(info, [&](int x, int y) { return *inside.at(x, y); });
  }

 private:
  MovingScene scene_{kFilm.width, kFilm.height};
  Texture around_{9, 12};
};

struct Felt {
  std::vector<MotionMessage> frames;
  std::vector<ObjectBox> boxes;  ///< on the last frame
  std::vector<std::string> warnings;
};

Felt feel(const std::string& properties, bool is_alone, int frames = kFrames) {
  ElementHarness h("device=none motion=object attach-meta=true " + properties);
  h.set_caps(is_alone ? make_caps("GRAY8", kFilm.width, kFilm.height)
                      : make_caps("GRAY8", kWidth, kHeight));
  Films films;
  Felt felt;
  for (int n = 0; n < frames; ++n) {
    GstBuffer* const out = h.pass(is_alone ? films.alone(n, h.info()) : films.picture(n, h.info()),
                                  static_cast<GstClockTime>(n) * kFrame);
    felt.boxes = read_object_metas(out);
    gst_buffer_unref(out);
  }
  felt.frames = h.motions();
  felt.warnings = h.warnings();
  return felt;
}

constexpr const char* kArea = "area=160,60,480,270 ";

void expect_same(const Felt& a, const Felt& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (size_t n = 0; n < a.frames.size(); ++n) {
    EXPECT_EQ(a.frames[n].velocity_x, b.frames[n].velocity_x) << n;
    EXPECT_EQ(a.frames[n].velocity_y, b.frames[n].velocity_y) << n;
    EXPECT_EQ(a.frames[n].wrench.force_N, b.frames[n].wrench.force_N) << n;
  }
}

TEST(Area, IsFeltAsTheFilmAlone) {
  const Felt alone = feel("", true);
  const Felt within = feel(kArea, false);
  ASSERT_GT(size_N(alone.frames.back().wrench), 0.1);
  expect_same(alone, within);
  const auto fraction = [](int part, int whole) {
    return std::to_string(static_cast<double>(part) / whole);
  };
  expect_same(alone,
              feel("area=" + fraction(kFilm.x, kWidth) + "," + fraction(kFilm.y, kHeight) + "," +
                       fraction(kFilm.width, kWidth) + "," + fraction(kFilm.height, kHeight) + " ",
                   false));
  ASSERT_EQ(alone.boxes.size(), 2u);
  ASSERT_EQ(within.boxes.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(within.boxes[i].x, kFilm.x + alone.boxes[i].x) << "in the frame";
    EXPECT_EQ(within.boxes[i].y, kFilm.y + alone.boxes[i].y);
    EXPECT_EQ(within.boxes[i].width, alone.boxes[i].width);
  }
}

/// A position so far from where the first disc begins, as fractions of the film or of the picture.
std::string beside(bool is_alone, double away_px) {
  const Vector2d middle_px(kFilm.width / 2.0, kFilm.height / 2.0);
  Vector2d at_px = middle_px + kFirst_px + Vector2d(away_px, away_px);
  if (!is_alone) at_px += Vector2d(kFilm.x, kFilm.y);
  return std::to_string(at_px.x() / (is_alone ? kFilm.width : kWidth)) + "," +
         std::to_string(at_px.y() / (is_alone ? kFilm.height : kHeight));
}

TEST(Area, LeavesRulesAndPointerInTheFrame) {
  const auto object = [](bool is_alone) {
    return "feel=\"object at " + beside(is_alone, 0) + "\"";
  };
  const auto region = [](bool is_alone) {
    return "feel=\"region " + beside(is_alone, -30) + " to " + beside(is_alone, 65) + "\"";
  };
  const auto pointer = [](bool is_alone) {
    return "motion=objects pointer=" + beside(is_alone, 0);
  };
  for (const std::function<std::string(bool)>& choice :
       {std::function<std::string(bool)>(object), std::function<std::string(bool)>(region),
        std::function<std::string(bool)>(pointer)}) {
    const Felt alone = feel(choice(true), true);
    EXPECT_GT(alone.frames.back().velocity_x, 50) << choice(true) << ": the first disc's";
    const Felt within = feel(kArea + choice(false), false);
    ASSERT_EQ(alone.frames.size(), within.frames.size());
    for (size_t n = 0; n < alone.frames.size(); ++n) {
      // Six decimals of a fraction are a thousandth of a pixel.
      EXPECT_NEAR(alone.frames[n].velocity_x, within.frames[n].velocity_x, 0.1) << choice(false);
      EXPECT_NEAR(alone.frames[n].velocity_y, within.frames[n].velocity_y, 0.1) << choice(false);
    }
  }
}

TEST(Area, ThatChangesBeginsAnew) {
  ElementHarness h(std::string("device=none motion=object ") + kArea);
  h.set_caps(make_caps("GRAY8", kWidth, kHeight));
  Films films;
  for (int n = 0; n < kFrames; ++n) {
    if (n == 5) g_object_set(h.element(), "area", "170,60,480,270", nullptr);
    h.push(films.picture(n, h.info()), static_cast<GstClockTime>(n) * kFrame);
  }
  const std::vector<MotionMessage>& frames = h.motions();
  EXPECT_EQ(frames[4].no_force, "none");
  EXPECT_EQ(frames[5].no_force, "nothing-to-compare");
  EXPECT_NE(frames[6].no_force, "nothing-to-compare");
}

TEST(Area, OutsideThePictureIsOnlyShown) {
  for (const char* area : {"area=900,0,100,100", "area=790,0,100,100"}) {
    const Felt felt = feel(area, false, 3);
    EXPECT_TRUE(felt.frames.empty()) << area;
    ASSERT_EQ(felt.warnings.size(), 1u) << area;
    EXPECT_NE(felt.warnings[0].find("area"), std::string::npos) << felt.warnings[0];
  }
  EXPECT_EQ(feel("area=500,300,9999,9999", false, 2).frames.size(), 2u) << "partly outside";
}

TEST(Area, IsReadAsItIsWritten) {
  for (const char* text :
       {"whole", "auto", "0,0,16,16", "160,60,480,270", "0.1,0.1,0.8,0.8", "0,0,1,1"}) {
    const std::optional<AreaSetting> area = parse_area(text);
    ASSERT_TRUE(area) << text;
    EXPECT_EQ(text_of(*area), text);
  }
  for (const char* text :
       {"", "all", "1,2,300", "1,2,300,200,5", "-1,0,300,200", "0,0,15,200", "0,0,300,15",
        "0,0,0x20,32", "0.5,0,300,200", "0.1,0.1,0,0.8", "1e-1,0,1,1", "0,0,300,99999999999999"}) {
    EXPECT_FALSE(parse_area(text)) << text;
  }
}

}  // namespace
}  // namespace spidar::test::area_test
