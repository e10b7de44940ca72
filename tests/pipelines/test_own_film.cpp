// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A track is accepted for the film that it was recorded from, in any container, and for no other.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/film_reader.h"
#include "plugin/track/sidecar.h"
#include "plugin/track/track_file.h"
#include "plugin/track/track_loader.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::own_film_test {
namespace {

/// Whether ffmpeg made the film.
bool ffmpeg(const std::string& arguments) {
  return std::system(("ffmpeg -nostdin -v error -y " + arguments).c_str()) == 0;
}

class OwnFilm : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }
  void SetUp() override {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
      GTEST_SKIP() << "ffmpeg is not installed";
    }
  }
  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  /// Two seconds of H.264 with B-frames, and so many seconds of AAC.
  bool make(const std::string& name, double sound_s = 2, const std::string& picture = "testsrc2",
            const std::string& options = "") const {
    return ffmpeg("-f lavfi -i " + picture + "=r=25:s=160x120 -f lavfi -i sine=r=48000:d=" +
                  std::to_string(sound_s) + " -map 0:v -map 1:a -frames:v 50 -c:v libx264 " +
                  "-preset ultrafast -bf 2 -c:a aac " + options + " " + path(name));
  }
  bool copy(const std::string& from, const std::string& to, const std::string& options = "") const {
    return ffmpeg("-i " + path(from) + " -c copy " + options + " " + path(to));
  }
  /// A track of two seconds, recorded from the film `own`, compared with `film`.
  FilmMatch match(const std::string& own, const std::string& film) const {
    const Film recorded = read_film(path(own));
    TrackNotes notes;
    notes.film = parse_fingerprint(to_text(fingerprint_of(recorded.packets)));
    EXPECT_FALSE(notes.film.empty());
    return match_film(read_film(path(film)), recorded.end_ns.value_or(0), notes);
  }
  std::string other(const std::string& own, const std::string& film) const {
    return match(own, film).problem;
  }

  TemporaryFolder folder;
};

TEST_F(OwnFilm, IsRecognisedInAnyContainer) {
  ASSERT_TRUE(make("film.mp4"));
  for (const char* name : {"copy.mkv", "copy.mov", "copy.flv", "silent.mp4"}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(copy("film.mp4", name, std::string(name) == "silent.mp4" ? "-an" : ""));
    EXPECT_EQ(other("film.mp4", name), "");
    EXPECT_EQ(other(name, "film.mp4"), "");
  }
  // In a transport stream the pictures begin later: the bytes are the same, the times are not.
  ASSERT_TRUE(copy("film.mp4", "copy.ts"));
  for (const auto& [own, film] : {std::pair{"film.mp4", "copy.ts"}, {"copy.ts", "film.mp4"}}) {
    const FilmMatch copied = match(own, film);
    EXPECT_EQ(copied.problem, "") << film;
    EXPECT_GT(std::llabs(copied.later_ns), 100'000'000) << film;
  }
  EXPECT_EQ(match("copy.ts", "copy.ts").later_ns, 0);
}

TEST_F(OwnFilm, ATrackMovesWithThePicturesIntoAnotherContainer) {
  ASSERT_TRUE(make("film.mp4"));
  ASSERT_TRUE(copy("film.mp4", "copy.ts"));
  ASSERT_EQ(spidartrack("record " + path("film.mp4")).status, 0);
  ASSERT_EQ(spidartrack("record " + path("copy.ts")).status, 0);
  const Film film = read_film(path("film.mp4")), copied = read_film(path("copy.ts"));
  const int64_t later_ns = copied.begin_ns - film.begin_ns;
  ASSERT_GT(std::llabs(later_ns), 100'000'000);
  for (const bool back : {false, true}) {
    SCOPED_TRACE(back);
    const std::string track = path(back ? "copy.ts" : "film.mp4") + ".haptic.flac";
    TrackLoader loader;
    loader.begin(track, path(back ? "film.mp4" : "copy.ts"));
    loader.await(std::chrono::hours(1));
    const std::optional<LoadedTrack> loaded = loader.take();
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->problem, "");
    // Times of MPEG-TS are multiples of 1/90 ms.
    EXPECT_NEAR(static_cast<double>(loaded->track->blocks.front().begin_ns -
                                    read_track_file(track).blocks.front().begin_ns),
                static_cast<double>(back ? -later_ns : later_ns), 1e6 / 90 * 2);
  }
}

TEST_F(OwnFilm, AnyOtherIsNot) {
  ASSERT_TRUE(make("film.mp4"));
  ASSERT_TRUE(make("mandelbrot.mp4", 2, "mandelbrot"));
  ASSERT_TRUE(make("anew.mp4", 2, "testsrc2", "-crf 30"));
  for (const char* name : {"mandelbrot.mp4", "anew.mp4"}) {
    expect_contains(other("film.mp4", name), "recorded from other pictures");
  }
  ASSERT_TRUE(copy("film.mp4", "cut.mkv", "-t 1"));
  expect_contains(other("film.mp4", "cut.mkv"), "the film 1.");
}

TEST_F(OwnFilm, WhatATrackSaysOfItselfIsKeptByEveryFormat) {
  SaveOptions options;
  options.notes.film =
      fingerprint_of({{0x12345678, 900, 40'000'000}, {0xfedcba98, 1000, 80'000'000}});
  for (const char* settings : {"", "max-force=2 motion=camera"}) {
    options.notes.settings = settings;
    for (const char* name : {"a.flac", "a.mka", "a.wav"}) {
      SCOPED_TRACE(name);
      save_track(path(name), std::vector<TrackSample>(500), options);
      TrackCondition condition;
      EXPECT_EQ(load_track(path(name), &condition).size(), 500u);
      for (const TrackNotes& notes : {condition.notes, read_track_notes(path(name))}) {
        EXPECT_EQ(to_text(notes.film), "80000000:fedcba9812345678");
        EXPECT_EQ(notes.settings, settings);
      }
    }
  }
  save_track(path("hand.wav"), std::vector<TrackSample>(500));
  EXPECT_FALSE(read_track_notes(path("hand.wav")).settings);
}

TEST_F(OwnFilm, ItsSoundMayBeLonger) {
  for (const char* name : {"film.mp4", "film.mkv", "film.flv"}) {
    for (const double sound_s : {2.03, 2.2, 7.0}) {
      SCOPED_TRACE(name + std::string(", sound ") + std::to_string(sound_s));
      ASSERT_TRUE(make(name, sound_s));
      const CommandResult recorded =
          spidartrack("record --force --format wav --folder " + path("") + " " + path(name));
      ASSERT_EQ(recorded.status, 0) << recorded.text;
      std::filesystem::path track;
      for (const auto& entry : std::filesystem::directory_iterator(folder.path)) {
        if (entry.path().extension() == ".wav") track = entry.path();
      }
      const Film film = read_film(path(name));
      TrackCondition condition;
      const auto track_ns =
          static_cast<int64_t>(load_track(track.string(), &condition).size()) * kTrackPeriod_ns;
      EXPECT_FALSE(condition.notes.film.empty());
      EXPECT_EQ(match_film(film, track_ns, condition.notes).problem, "");
      // Without notes, as made by hand or by older versions.
      EXPECT_EQ(match_film(film, track_ns, {}).problem, "");
      std::filesystem::remove(track);
    }
  }
}

}  // namespace
}  // namespace spidar::test::own_film_test
