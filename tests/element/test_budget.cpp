// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The budget of processor time. The budgets are such that every frame, or none, is above them.
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "core/analysis/work_ladder.h"
#include "tests/support/element_harness.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture.h"
#include "tests/support/video_frames.h"

namespace spidar::test::budget_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr int kTooLittle_us = 1;
constexpr int kPlenty_us = 1'000'000;
constexpr gint kFullQuality = 1'000'000;
constexpr gint kLeastQuality = 200'000;

/// An element that sees a disc cross a texture that stays.
class Film {
 public:
  explicit Film(const std::string& properties)
      : h("device=none motion=object max-force=3 " + properties) {
    h.set_caps(make_caps("GRAY8", kWidth, kHeight));
  }

  void play(int frames) {
    const Texture wall(1, 10);
    const Texture disc(2, 10);
    for (const int end = n_ + frames; n_ < end; ++n_) {
      const double middle = 100 + 60 * std::sin(0.1 * n_);
      GstBuffer* buffer = gst_buffer_new_allocate(nullptr, kWidth * kHeight, nullptr);
      GstMapInfo map;
      gst_buffer_map(buffer, &map, GST_MAP_WRITE);
      for (int i = 0; i < kWidth * kHeight; ++i) {
        const double x = i % kWidth, y = i / kWidth;
        const bool on_disc = std::hypot(x - middle, y - 100) < 60;
        const double grey = on_disc ? disc.at(x - middle, y) : wall.at(x, y);
        map.data[i] = static_cast<guint8>(std::lround(grey));
      }
      gst_buffer_unmap(buffer, &map);
      ASSERT_EQ(h.push(buffer, static_cast<GstClockTime>(n_) * kFrame), GST_FLOW_OK);
      gst_buffer_unref(gst_harness_pull(h.harness()));
    }
  }

  void set_budget(int us) { g_object_set(h.element(), "budget", us, nullptr); }

  guint64 count(const char* field) {
    GstStructure* stats = nullptr;
    g_object_get(h.element(), "stats", &stats, nullptr);
    guint64 number = 0;
    guint small = 0;
    if (gst_structure_get_uint(stats, field, &small)) number = small;
    gst_structure_get_uint64(stats, field, &number);
    gst_structure_free(stats);
    return number;
  }

  double force_N() { return h.motions().back().wrench.force_N.norm(); }

  ElementHarness h;

 private:
  static constexpr int kWidth = 320;
  static constexpr int kHeight = 240;
  int n_ = 0;
};

void expect_nothing_left_out(Film& film) {
  EXPECT_EQ(film.count("budget-rung"), 0u);
  EXPECT_EQ(film.count("above-budget"), 0u);
  EXPECT_TRUE(film.h.qualities().empty());
}

TEST(Budget, WithTooLittleTheLeastIsDoneAndTheForceIsStillThere) {
  Film film("budget=" + std::to_string(kTooLittle_us));
  film.play(30);
  EXPECT_EQ(film.count("budget-rung"), static_cast<guint64>(WorkLadder::kLowest));
  EXPECT_EQ(film.count("above-budget"), 30u);
  EXPECT_EQ(film.h.qualities(), std::vector<gint>{kLeastQuality});
  EXPECT_EQ(film.h.motions().size(), 30u);
  EXPECT_GT(film.force_N(), 0.1);
  EXPECT_TRUE(film.h.warnings().empty());
}

TEST(Budget, WithPlentyAllIsDoneSoon) {
  Film film("budget=" + std::to_string(kPlenty_us));
  film.play(30);
  EXPECT_EQ(film.count("budget-rung"), 0u);
  EXPECT_EQ(film.count("above-budget"), 0u);
  EXPECT_EQ(film.h.qualities(), (std::vector<gint>{kLeastQuality, kFullQuality}));
}

TEST(Budget, NoneSaysNothing) {
  Film film("");
  film.play(10);
  expect_nothing_left_out(film);
}

TEST(Budget, ChangesWhilePlaying) {
  Film film("");
  film.play(10);
  film.set_budget(kTooLittle_us);
  film.play(10);
  EXPECT_EQ(film.count("budget-rung"), static_cast<guint64>(WorkLadder::kLowest));
  EXPECT_GT(film.force_N(), 0.1);
  film.set_budget(kPlenty_us);
  film.play(20);
  film.set_budget(0);
  film.play(2);
  EXPECT_EQ(film.count("budget-rung"), 0u);
  EXPECT_EQ(film.count("above-budget"), 10u);
  EXPECT_EQ(film.h.qualities(), (std::vector<gint>{kLeastQuality, kFullQuality}));
  film.set_budget(kTooLittle_us);
  film.play(2);
  film.set_budget(0);
  film.play(2);
  EXPECT_EQ(film.h.qualities().back(), kFullQuality);
  EXPECT_EQ(film.count("budget-rung"), 0u);
}

TEST(Budget, DoesNothingWithTheMeanOfPoints) {
  Film film("budget=1 motion=mean");
  film.play(5);
  expect_nothing_left_out(film);
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Budget, DoesNotChangeWhatIsRecorded) {
  const TemporaryFolder folder;
  std::string files[2];
  for (const int budget_us : {0, kTooLittle_us}) {
    const std::string path = (folder.path / "film.motion").string();
    {
      Film film("budget=" + std::to_string(budget_us) + " trace=" + path);
      film.play(10);
    }
    files[budget_us == 0 ? 0 : 1] = bytes_of(path);
  }
  EXPECT_FALSE(files[0].empty());
  EXPECT_EQ(files[0], files[1]);
}

TEST(Budget, WrongValuesAreRefused) {
  ElementHarness h;
  const auto* spec = reinterpret_cast<GParamSpecUInt*>(
      g_object_class_find_property(G_OBJECT_GET_CLASS(h.element()), "budget"));
  ASSERT_NE(spec, nullptr);
  EXPECT_EQ(spec->default_value, 0u);
  EXPECT_EQ(spec->maximum, 1'000'000u);
  GError* error = nullptr;
  GstElement* element = gst_parse_launch("spidarmotion budget=fast", &error);
  EXPECT_NE(error, nullptr);
  g_clear_error(&error);
  if (element) gst_object_unref(element);
  // As in every element, GObject leaves a property as it was, with a warning.
  guint budget = 0;
  GValue large = G_VALUE_INIT;
  g_value_init(&large, G_TYPE_UINT);
  g_value_set_uint(&large, 2'000'000);
  g_object_set_property(G_OBJECT(h.element()), "budget", &large);
  g_object_get(h.element(), "budget", &budget, nullptr);
  EXPECT_EQ(budget, 0u);
}

}  // namespace
}  // namespace spidar::test::budget_test
