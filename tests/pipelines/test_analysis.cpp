// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A film is measured once: spidartrack analyze and render, and spidarmotion analysis=.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/analysis/cbor_items.h"
#include "plugin/tools/track_samples.h"
#include "tests/pipelines/launched.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::analysis_test {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 40;

std::string source(const std::string& properties, int width = 320, int height = 240) {
  return "videotestsrc num-buffers=" + std::to_string(kFrames) + " " + properties +
         " ! video/x-raw,width=" + std::to_string(width) + ",height=" + std::to_string(height) +
         ",framerate=25/1 ! ";
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Analysis : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  std::string make_film(const std::string& name, const std::string& pictures,
                        const std::string& encoding = "jpegenc ! avimux") const {
    run_pipeline(pictures + encoding + " ! filesink location=" + quoted(path(name)));
    return path(name);
  }
  std::string analyze(const std::string& film, const std::string& options = "") const {
    const CommandResult result = spidartrack("analyze " + quoted(film) + " " + options);
    EXPECT_EQ(result.status, 0) << result.text;
    return film + ".motion";
  }
  /// Whether the analysis gives the track that the film does, bit by bit, and is felt at all.
  void expect_same(const std::string& film, const std::string& settings) const {
    SCOPED_TRACE(film + " " + settings);
    const std::string recorded = film + ".haptic.wav", rendered = path("rendered.wav");
    const std::string properties = settings.empty() ? "" : " -- " + settings;
    const CommandResult record =
        spidartrack("record --force --format wav " + quoted(film) + properties);
    EXPECT_EQ(record.status, 0) << record.text;
    const CommandResult render =
        spidartrack("render " + quoted(film + ".motion") + " " + rendered + properties);
    EXPECT_EQ(render.status, 0) << render.text;
    EXPECT_TRUE(bytes_of(recorded) == bytes_of(rendered));
    const std::vector<TrackSample> track = load_track(rendered);
    EXPECT_GT(largest_difference(track, std::vector<TrackSample>(track.size())), 0.005);
  }
  void expect_refused(const std::string& arguments, int status, const std::string& why) const {
    const CommandResult result = spidartrack(arguments);
    EXPECT_EQ(result.status, status) << arguments;
    expect_contains(result.text, why);
  }
  /// In real time; `between` stands between decoder and element.
  static Outcome play(const std::string& film, const std::string& analysis,
                      const std::string& between = "") {
    return launch("filesrc location=" + quoted(film) + " ! avidemux ! jpegdec ! " + between +
                  "videoconvert ! spidarmotion analysis=" + quoted(analysis) +
                  " ! queue ! fakesink sync=true");
  }

  TemporaryFolder folder;
};

TEST_F(Analysis, RendersTheTrackThatRecordMakesToTheLastBit) {
  const std::string ball = make_film("a ball, 'quoted'.avi", source("pattern=ball"));
  analyze(ball);
  for (const char* settings : {"", "controller=adaptive max-force=2", "motion=objects alpha=0.02",
                               "filter-min-cutoff=0 depth-gain=0 roll-gain=3"}) {
    expect_same(ball, settings);
  }
}

TEST_F(Analysis, OfCutsRepeatedPicturesAndSeveralObjectsToo) {
  // Two films one after the other, in one with time stamps that round.
  run_pipeline("concat name=c ! jpegenc ! matroskamux ! filesink location=" + path("cut.mkv") +
               " " + source("pattern=ball") + "c. " +
               source("pattern=ball motion=sweep flip=true") + "c.");
  make_film("repeated.avi", source("pattern=ball") +
                                "videorate ! video/x-raw,framerate=12/1 ! videorate ! "
                                "video/x-raw,framerate=25/1 ! ");
  const std::string small = " pattern=ball motion=";
  run_pipeline(
      "compositor name=c sink_0::xpos=0 sink_1::xpos=160 sink_2::ypos=120 "
      "background=black ! video/x-raw,width=320,height=240 ! jpegenc ! avimux ! filesink "
      "location=" +
      path("objects.avi") + " " + source(small + "wavy", 160, 120) + "c. " +
      source(small + "sweep", 160, 120) + "c. " + source(small + "hsweep", 160, 120) + "c.");
  const std::pair<const char*, std::vector<std::string>> films[] = {
      {"cut.mkv", {"", "controller=linear"}},
      {"repeated.avi", {"", "motion=objects controller=adaptive"}},
      {"objects.avi", {"", "motion=objects pointer-x=0.1 pointer-y=0.9", "motion=objects"}}};
  for (const auto& [film, all_settings] : films) {
    analyze(path(film));
    for (const std::string& settings : all_settings) expect_same(path(film), settings);
  }
}

TEST_F(Analysis, OfAFilmThatIsTurnedAndOfTheCameraToo) {
  run_pipeline(
      "videotestsrc num-buffers=40 pattern=zone-plate kx2=20 ky2=20 horizontal-speed=4 ! "
      "video/x-raw,width=320,height=240,framerate=25/1 ! jpegenc ! "
      "taginject tags=\"image-orientation=rotate-90\" ! qtmux ! filesink location=" +
      path("telephone.mov"));
  analyze(path("telephone.mov"));
  for (const char* settings : {"motion=camera", "motion=camera controller=linear max-force=1"}) {
    expect_same(path("telephone.mov"), settings);
  }
}

TEST_F(Analysis, IsFeltByRulesAsTheFilmIs) {
  const std::string film = make_film("ball.avi", source("pattern=ball"));
  analyze(film);
  for (const char* rules : {"0-0.8 object at 0.5,0.5 gain 2; 0.8- largest", "leftmost gain 0.5",
                            "0.2-1 region 0,0 to 1,0.6; 1-1.3 nothing"}) {
    expect_same(film, "feel=" + shell_word(rules));
  }
  std::ofstream(film + ".feel") << "# of this film\n0:00-0:01 largest gain 0.5\n";
  expect_same(film, "feel=auto");
  // A track tells by which rules it was made, wherever they were.
  const CommandResult there = spidartrack(
      "record " + quoted(film) + " --format wav -- feel=" + shell_word("0-1.0 largest gain .5"));
  EXPECT_EQ(there.status, 0) << there.text;
  expect_contains(there.text, "is there");
  std::ofstream(film + ".feel") << "0:00-0:01 largest\n";
  expect_refused("record " + quoted(film) + " --format wav -- feel=auto", 1,
                 "was recorded with feel=\"0:00-0:01 largest gain 0.5\", and not with "
                 "feel=\"0:00-0:01 largest\"");
}

TEST_F(Analysis, SaysWhichRulesCannotBeFollowed) {
  const std::string film = make_film("ball.avi", source("pattern=ball"));
  const std::string motion = analyze(film);
  expect_refused("render " + motion + " -- feel=" + shell_word("0-1 camera; 1-2 bigest"), 2,
                 "feel, line 2: \"bigest\" is none of: object at X,Y; largest; ");
  expect_refused("record " + film + " -- feel=" + path("none.feel"), 2,
                 path("none.feel") + ": there is no such file");
  expect_refused("analyze " + film + " -- feel=largest", 2, "it is for spidartrack render");
  std::ofstream(film + ".feel") << "0:00-0:01 largest\n0:00.5- camera\n";
  for (const std::string& command : {"render " + motion, "record " + film}) {
    expect_refused(command + " -- feel=auto", 1,
                   film +
                       ".feel, line 2: it begins at 0:00.5, before line 1 ends, which does so "
                       "at 0:01");
  }
  // What shows only with the film is told, and the track is made.
  const CommandResult told =
      spidartrack("render " + motion + " -- feel=" +
                  shell_word("0-0.4 largest; 0.4-1 object at 0.01,0.01; 2:00- camera"));
  EXPECT_EQ(told.status, 0) << told.text;
  expect_contains(told.text, "feel, line 2: no object was at 0.01,0.01 at 0:00.4.");
  expect_contains(told.text, "feel, line 3: it begins at 2:00, but the film ends at 0:01.6.");
}

TEST_F(Analysis, OfThePapersMeanIsOneOfItsOwn) {
  const std::string film = make_film("ball.avi", source("pattern=ball"));
  const std::string motion = analyze(film, "-- motion=mean");
  expect_same(film, "motion=mean max-force=1");
  expect_refused("render " + motion + " -- motion=camera", 1, "it was measured for motion=mean");
  spidartrack("analyze --force " + film);
  expect_refused("render " + motion + " -- motion=mean", 1, "analyze FILM -- motion=mean");
}

TEST_F(Analysis, WithAnotherQualityIsTheTrackOfThatQuality) {
  const std::string film = make_film("ball.avi", source("pattern=ball"));
  const std::string motion = analyze(film, "-- quality=fine");
  const CommandResult render = spidartrack("render " + motion + " -- max-force=2");
  EXPECT_EQ(render.status, 0) << render.text;
  // record knows it as what it would make itself.
  const CommandResult there = spidartrack("record " + film + " -- quality=fine max-force=2");
  EXPECT_EQ(there.status, 0) << there.text;
  expect_contains(there.text, "is there");
  expect_refused("analyze " + film, 1, "was recorded with quality=fine, and not with the defaults");
}

TEST_F(Analysis, IsDescribedByInfo) {
  const std::string motion =
      analyze(make_film("ball.avi", source("pattern=ball")), "-- quality=fine");
  const CommandResult info = spidartrack("info " + motion);
  EXPECT_EQ(info.status, 0);
  expect_contains(info.text, "analysis of 40 frames, 1.6 s, with quality=fine");
  expect_contains(info.text, "objects: 1, in ");
  const CommandResult json = spidartrack("info --json " + motion);
  EXPECT_EQ(json.status, 0);
  expect_contains(json.text,
                  R"("frames":40,"duration_s":1.6,"settings":"quality=fine","objects":1,)");
  fs::resize_file(motion, fs::file_size(motion) - 1);
  expect_refused("info " + motion, 1, motion + ": its end is missing: analyse the film again");
}

TEST_F(Analysis, IsExportedAsLinesOfJson) {
  const std::string film = make_film("ball.avi", source("pattern=ball"));
  const std::string lines = path("ball.jsonl");
  const CommandResult render =
      spidartrack("render " + analyze(film) + " -- trace=" + quoted(lines));
  EXPECT_EQ(render.status, 0) << render.text;
  const std::string live = path("live.jsonl");
  EXPECT_EQ(spidartrack("record " + film + " --force -- trace=" + quoted(live)).status, 0);
  EXPECT_EQ(bytes_of(lines), bytes_of(live));
}

TEST_F(Analysis, RefusesWhatItCannotRender) {
  const std::string film = make_film("ball.avi", source("pattern=ball"));
  const std::string motion = analyze(film);
  expect_refused("render " + film, 1, "it is no analysis of a film");
  expect_refused("render " + path("none.motion"), 1, "there is no such file");
  expect_refused("render " + motion + " -- quality=fine", 2, "changes what is measured");
  expect_refused("render " + motion + " -- device=sim", 2, "changes nothing in a track");
  expect_refused("render " + motion + " track.mp3", 2, "ends in none of .flac, .mka, .wav");
  expect_refused("analyze " + film + " -- max-force=2", 2, "it is for spidartrack render");
  for (const char* command : {"analyze ", "record ", "render "})
    expect_refused(command + film + " -- budget=300", 2, "what is recorded is the same on every");
  const std::string whole = bytes_of(motion);
  std::ofstream(motion, std::ios::binary) << whole.substr(0, whole.size() / 2);
  expect_refused("render " + motion, 1, "its end is missing");
  EXPECT_FALSE(fs::exists(film + ".haptic.flac"));
  // An analysis of another film, under the name of this one.
  const std::string other = make_film("other.avi", source("pattern=ball motion=sweep"));
  fs::rename(analyze(other), motion);
  expect_refused("analyze " + film, 1, "is the analysis of another film");
}

TEST_F(Analysis, IsPlayedInPlaceOfThePictures) {
  const std::string film = make_film("ball.avi", source("pattern=ball"));
  const Outcome live = play(film, "");
  analyze(film);
  for (const std::string& analysis : {film + ".motion", std::string("auto")}) {
    // What reaches the element is black.
    const Outcome outcome = play(film, analysis, "videobalance brightness=-1 contrast=0 ! ");
    EXPECT_TRUE(outcome.eos) << outcome.error;
    EXPECT_TRUE(outcome.warnings.empty()) << outcome.warnings[0];
    EXPECT_EQ(outcome.motions, kFrames);
    EXPECT_GT(outcome.largest_force_N, 0.05);
    EXPECT_EQ(outcome.largest_force_N, live.largest_force_N);
  }
}

TEST_F(Analysis, WhatItWasNotMeasuredWithIsNamed) {
  const std::string film = make_film("ball.avi", source("pattern=ball"));
  analyze(film);
  const auto warnings = [&](const std::string& settings) {
    return launch("filesrc location=" + quoted(film) +
                  " ! avidemux ! jpegdec ! videoconvert ! spidarmotion " + settings + " ! fakesink")
        .warnings;
  };
  EXPECT_TRUE(warnings("analysis=auto motion=objects").empty());
  const std::vector<std::string> quality = warnings("analysis=auto quality=fine");
  ASSERT_EQ(quality.size(), 1u);
  expect_contains(quality[0], "quality=fine has no effect while the analysis ");
  const CommandResult fine = spidartrack("analyze --force " + quoted(film) + " -- quality=fine");
  EXPECT_EQ(fine.status, 0) << fine.text;
  EXPECT_TRUE(warnings("analysis=auto quality=fine").empty());
  const CommandResult record = spidartrack("record " + quoted(film));
  EXPECT_EQ(record.status, 0) << record.text;
  EXPECT_TRUE(warnings("track=auto").empty());
  const std::vector<std::string> feel = warnings("track=auto feel=\"0:00-0:01 camera\"");
  ASSERT_EQ(feel.size(), 1u);
  expect_contains(feel[0], "feel=0:00-0:01 camera has no effect while the haptic track ");
}

TEST_F(Analysis, ThatCannotBeUsedIsNamedAndTheFilmIsAnalysed) {
  const std::string film = make_film("ball.avi", source("pattern=ball"));
  const std::string other = analyze(make_film("other.avi", source("pattern=ball motion=sweep")));
  const std::string whole = bytes_of(other);
  std::ofstream(path("half.motion"), std::ios::binary) << whole.substr(0, whole.size() / 2);
  std::ofstream(path("new.motion"), std::ios::binary)
      << write_cbor({{{"version", 2}}, {{"format", "gst-spidar motion"}}, {}});
  const std::pair<std::string, const char*> cases[] = {
      {other, "recorded from other pictures"},
      {path("half.motion"), "its end is missing"},
      {path("new.motion"), "it has version 2"},
      {film, "it is no analysis of a film"},
      {path("none.motion"), "there is no such file"}};
  for (const auto& [file, why] : cases) {
    SCOPED_TRACE(file);
    const Outcome outcome = play(film, file);
    EXPECT_TRUE(outcome.eos) << outcome.error;
    ASSERT_EQ(outcome.warnings.size(), 1u);
    expect_contains(outcome.warnings[0], why);
    EXPECT_EQ(outcome.motions, kFrames) << "analysed";
  }
}

}  // namespace
}  // namespace spidar::test::analysis_test
