// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidartrack record with films as people have them: tracks lie in time, and a film that is
// damaged, or has no video, is an error that says so.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "plugin/tools/track_samples.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::film_recorder_test {
namespace {

namespace fs = std::filesystem;

class FilmRecorder : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }

  /// Two seconds of a ball.
  void make_film(const std::string& name, const std::string& encoding) const {
    run_pipeline(
        "videotestsrc num-buffers=50 pattern=ball ! "
        "video/x-raw,width=320,height=240,framerate=25/1 ! " +
        encoding + " ! filesink location=" + quoted(path(name)));
  }

  /// Records, and expects an error with `cause` that leaves no file behind.
  void expect_refused(const std::string& name, const std::string& cause) const {
    SCOPED_TRACE(name);
    const CommandResult result =
        spidartrack("record --folder " + path("out") + " " + quoted(path(name)));
    EXPECT_EQ(result.status, 1);
    expect_contains(result.text, "failed: " + cause);
    EXPECT_TRUE(fs::is_empty(folder.path / "out"));
  }

  void SetUp() override { fs::create_directory(folder.path / "out"); }

  TemporaryFolder folder;
};

TEST_F(FilmRecorder, AFilmThatIsCutOffIsAnErrorAndLeavesNoFile) {
  make_film("whole.mkv", "jpegenc ! matroskamux");
  EXPECT_EQ(spidartrack("record " + path("whole.mkv")).status, 0);
  fs::copy(path("whole.mkv"), path("half.mkv"));
  fs::resize_file(path("half.mkv"), fs::file_size(path("whole.mkv")) / 2);
  expect_refused("half.mkv", "it ends at ");
  fs::resize_file(path("half.mkv"), 1000);  // before the first frame ends
  expect_refused("half.mkv", "");
  make_film("flat.mov", "jpegenc ! qtmux faststart=true");
  fs::resize_file(path("flat.mov"), fs::file_size(path("flat.mov")) / 2);
  expect_refused("flat.mov", "it ends at ");
  // Only the header, of a film with sound.
  std::ofstream(path("header.flv"), std::ios::binary).write("FLV\1\5\0\0\0\t\0\0\0\0", 13);
  expect_refused("header.flv", "it cannot be read to its end");
}

TEST_F(FilmRecorder, WhereAFileIsCutOffDoesNotMatter) {
  const std::pair<const char*, const char*> kinds[] = {
      {"avi", "jpegenc ! avimux"},
      {"ogg", "theoraenc ! oggmux"},
      {"mkv", "jpegenc ! matroskamux"},
      {"mov", "jpegenc ! qtmux fragment-duration=200"}};
  for (const auto& [extension, encoding] : kinds) {
    const std::string whole = std::string("whole.") + extension, half = "half." + whole;
    SCOPED_TRACE(whole);
    make_film(whole, encoding);
    EXPECT_EQ(spidartrack("record " + path(whole)).status, 0);
    fs::copy(path(whole), path(half));
    // In the last page, chunk, segment or box as well as in the middle.
    for (const uintmax_t size : {fs::file_size(path(whole)) - 1, fs::file_size(path(whole)) / 2}) {
      fs::resize_file(path(half), size);
      expect_refused(half, "");
      fs::copy_file(path(whole), path(half), fs::copy_options::overwrite_existing);
    }
  }
}

TEST_F(FilmRecorder, SoundMayGoOnAfterThePicturesOfAnOgg) {
  run_pipeline("oggmux name=mux ! filesink location=" + path("long.ogg") +
               " videotestsrc num-buffers=50 pattern=ball ! video/x-raw,framerate=25/1 ! "
               "theoraenc ! mux. audiotestsrc num-buffers=300 samplesperbuffer=1024 ! "
               "audio/x-raw,rate=48000 ! audioconvert ! vorbisenc ! mux.");
  const CommandResult result = spidartrack("record " + path("long.ogg"));
  EXPECT_EQ(result.status, 0) << result.text;
}

TEST_F(FilmRecorder, WhatHasNoMotionSaysSo) {
  run_pipeline("audiotestsrc num-buffers=20 ! matroskamux ! filesink location=" +
               path("sound.mkv"));
  expect_refused("sound.mkv", "there is no video in it");
  // qtdemux takes such pictures for a preview.
  run_pipeline("qtmux name=mux ! filesink location=" + path("short.mp4") +
               " videotestsrc num-buffers=25 ! video/x-raw,framerate=25/1 ! jpegenc ! mux. "
               "audiotestsrc num-buffers=300 samplesperbuffer=1000 ! "
               "audio/x-raw,rate=48000 ! mux.");
  expect_refused("short.mp4", "there is no video in it (GStreamer leaves out what is shorter");
  run_pipeline("videotestsrc num-buffers=1 ! pngenc ! filesink location=" + path("picture.png"));
  expect_refused("picture.png", "it is a single picture");
}

TEST_F(FilmRecorder, TimeStampsThatJumpByDaysAreAnError) {
  // From the eleventh frame on a million seconds later.
  run_pipeline(
      "concat name=c ! matroskamux ! filesink location=" + path("jump.mkv") +
      " videotestsrc num-buffers=10 pattern=ball ! jpegenc ! c. "
      "videotestsrc num-buffers=10 pattern=ball timestamp-offset=1000000000000000 ! jpegenc ! c.");
  expect_refused("jump.mkv", "The time stamps of the video jump from 0.3");
}

/// When force begins in a track, in milliseconds; -1 if it does not.
int onset_ms(const std::vector<TrackSample>& track) {
  for (size_t i = 0; i < track.size(); ++i) {
    if (std::fabs(track[i][0]) > 0.01F) return static_cast<int>(i);
  }
  return -1;
}

bool has_encoder() {
  return std::system(
             "ffmpeg -v error -f lavfi -i testsrc2=d=0.1 -c:v libx264 -f null - 2>/dev/null") == 0;
}

/// A picture stands still for a second and then moves to the right.
const std::string kMovingPicture =
    "ffmpeg -v error -y -f lavfi -i \"color=gray:s=480x240:r=25,noise=alls=60:all_seed=1,"
    "gblur=2,trim=end_frame=1,loop=-1:1,setpts=N/25/TB,crop=320:240:"
    "'if(lt(n,25),100,100-4*(n-25))':0\" ";

// The same film without sound and
// with B-frames is the measure; where the sound of the others begins 21 ms before the pictures,
// matroskademux moves its segment after the first frame; MPEG-TS does not begin at 0.
TEST_F(FilmRecorder, AFilmWithBFramesAndSoundIsFeltWhenItIsShown) {
  if (!has_encoder()) GTEST_SKIP() << "ffmpeg with libx264 is not installed";
  const std::string picture = kMovingPicture;
  const std::string sound = "-f lavfi -i sine=d=2:r=48000 ";
  const std::string encoding = "-t 2 -c:v libx264 -bf 3 -c:a aac ";
  ASSERT_EQ(std::system((picture + encoding + path("silent.mp4")).c_str()), 0);
  ASSERT_EQ(std::system((picture + sound + encoding + path("sound.mkv")).c_str()), 0);
  ASSERT_EQ(std::system((picture + sound + encoding + path("sound.ts")).c_str()), 0);
  // Begins with the sound: 21.3 ms of AAC come before the time 0 of ffmpeg, and Matroska counts
  // milliseconds. GStreamer counts those of the transport stream from its first clock reference,
  // 780 ms before the first picture.
  for (const char* format : {"wav", "flac"}) {
    SCOPED_TRACE(format);
    const CommandResult result = spidartrack(std::string("record --format ") + format + " " +
                                             path("silent.mp4") + " -- motion=mean");
    ASSERT_EQ(result.status, 0) << result.text;
    const int plain_ms = onset_ms(load_track(path(std::string("silent.mp4.haptic.") + format)));
    ASSERT_GT(plain_ms, 900);
    for (const auto& [name, later_ms] : {std::pair("sound.mkv", 21), std::pair("sound.ts", 780)}) {
      SCOPED_TRACE(name);
      const CommandResult recorded =
          spidartrack(std::string("record --force --folder ") + path("out") + " --format " +
                      format + " " + path(name) + " -- motion=mean");
      ASSERT_EQ(recorded.status, 0) << recorded.text;
      const std::vector<TrackSample> track =
          load_track(path(std::string("out/") + name + ".haptic." + format));
      EXPECT_NEAR(onset_ms(track), plain_ms + later_ms, 1);
    }
  }
}

// A film of a telephone held upright: its picture is stored on its side, with a tag. ffmpeg turns
// the picture when it decodes the film, and videoflip in a pipeline, where the tag may stay.
TEST_F(FilmRecorder, AFilmThatIsTurnedWhenItIsShownIsFeltAsItIsShown) {
  if (!has_encoder()) GTEST_SKIP() << "ffmpeg with libx264 is not installed";
  const std::string copy = "-i " + path("stored.mp4") + " -c copy ";
  // Newer releases of ffmpeg have -display_rotation in place of rotate=90.
  const std::string make = kMovingPicture + "-t 2 -c:v libx264 " + path("stored.mp4") +
                           " && (ffmpeg -v quiet -y -display_rotation 90 " + copy +
                           path("turned.mp4") + " || ffmpeg -v error -y " + copy +
                           "-metadata:s:v rotate=90 " + path("turned.mp4") +
                           ") && ffmpeg -v error -y -i " + path("turned.mp4") +
                           " -c:v libx264 -metadata:s:v rotate=0 " + path("upright.mp4");
  ASSERT_EQ(std::system(make.c_str()), 0);
  for (const char* film : {"stored", "turned", "upright"}) {
    const CommandResult result =
        spidartrack("record --format wav " + path(film + std::string(".mp4")) + " -- motion=mean");
    ASSERT_EQ(result.status, 0) << result.text;
  }
  run_pipeline(
      "filesrc location=" + path("turned.mp4") +
      " ! decodebin ! videoconvert ! videoflip video-direction=auto ! spidarmotion "
      "motion=mean device=none attach-meta=true ! spidarextract name=x x.wrench ! wavenc ! "
      "filesink location=" +
      path("flipped.mp4.haptic.wav"));
  const auto at_end = [this](const std::string& name) {
    return load_track(path(name + ".mp4.haptic.wav")).at(1800);
  };
  const TrackSample stored = at_end("stored");
  ASSERT_GT(stored[0], 0.01F) << "to the right";
  // A wrong turn differs by the whole force in at least one direction; a film that is coded again,
  // and analysed lying on its side, by about a tenth.
  const float tolerance = stored[0] / 5;
  // Up or down: as ffmpeg shows the film.
  const TrackSample upright = at_end("upright");
  EXPECT_NEAR(upright[0], 0, tolerance);
  EXPECT_NEAR(std::fabs(upright[1]), stored[0], tolerance);
  for (const char* name : {"turned", "flipped"}) {
    SCOPED_TRACE(name);
    const TrackSample felt = at_end(name);
    EXPECT_NEAR(felt[0], upright[0], tolerance);
    EXPECT_NEAR(felt[1], upright[1], tolerance);
  }
}

}  // namespace
}  // namespace spidar::test::film_recorder_test
