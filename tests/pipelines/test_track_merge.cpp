// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Films that contain a haptic track: how players handle them, and which films are refused.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/film_reader.h"
#include "plugin/track/track_file.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::track_merge_test {
namespace {

namespace fs = std::filesystem;

/// The data that a player sent to its audio sink.
struct Heard {
  std::vector<guint8> bytes;
  std::string caps;
};

void hear(GstElement*, GstBuffer* buffer, GstPad* pad, gpointer user) {
  auto& heard = *static_cast<Heard*>(user);
  if (heard.caps.empty()) {
    GstCaps* caps = gst_pad_get_current_caps(pad);
    gchar* text = gst_caps_to_string(caps);
    heard.caps = text;
    g_free(text);
    gst_caps_unref(caps);
  }
  GstMapInfo map;
  gst_buffer_map(buffer, &map, GST_MAP_READ);
  heard.bytes.insert(heard.bytes.end(), map.data, map.data + map.size);
  gst_buffer_unmap(buffer, &map);
}

/// Keeps the flags of a stream of sound, and lets the stream go nowhere.
void look_at(GstElement*, GstPad* pad, gpointer user) {
  GstCaps* caps = gst_pad_get_current_caps(pad);
  int channels = 0;
  gst_structure_get_int(gst_caps_get_structure(caps, 0), "channels", &channels);
  gst_caps_unref(caps);
  GstEvent* event = gst_pad_get_sticky_event(pad, GST_EVENT_STREAM_START, 0);
  GstStreamFlags stream_flags;
  gst_event_parse_stream_flags(event, &stream_flags);
  gst_event_unref(event);
  if (channels > 0) (*static_cast<std::map<int, GstStreamFlags>*>(user))[channels] = stream_flags;
  GstElement* sink = gst_element_factory_make("fakesink", nullptr);
  GstObject* pipeline = gst_object_get_parent(GST_OBJECT(GST_PAD_PARENT(pad)));
  gst_bin_add(GST_BIN(pipeline), sink);
  gst_object_unref(pipeline);
  g_object_set(sink, "sync", FALSE, "async", FALSE, nullptr);
  gst_element_sync_state_with_parent(sink);
  GstPad* into = gst_element_get_static_pad(sink, "sink");
  gst_pad_link(pad, into);
  gst_object_unref(into);
}

class TrackMerge : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }
  void SetUp() override {
    const std::string video =
        "videotestsrc num-buffers=50 pattern=ball ! video/x-raw,width=64,height=48,framerate=25/1 "
        "! jpegenc ! mux. ";
    // 0.02 s in each buffer.
    const std::string sound =
        "audiotestsrc num-buffers=100 samplesperbuffer=960 wave=ticks ! "
        "audio/x-raw,format=S16LE,rate=48000,channels=2 ! mux.";
    run_pipeline("avimux name=mux ! filesink location=" + quoted(path("film.avi")) + " " + video +
                 sound);
    run_pipeline("avimux name=mux ! filesink location=" + quoted(path("silent.avi")) + " " + video);
    save_track(path("track.wav"), samples());
    save_track(path("track.flac"), samples());
  }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  std::vector<TrackSample> samples(int count = 2000) const {
    std::vector<TrackSample> track;
    for (int i = 0; i < count; ++i) {
      const auto x = static_cast<float>(0.05 * std::sin(0.01 * i));
      track.push_back({x, 2 * x, -3 * x, x / 2, -x / 3, x / 4});
    }
    return track;
  }
  CommandResult merge(const std::string& film, const std::string& track,
                      const std::string& out) const {
    return spidartrack("merge " + path(film) + " " + path(track) + " " + path(out));
  }

  static bool has_ffmpeg() { return std::system("ffmpeg -version > /dev/null 2>&1") == 0; }
  static bool ffmpeg(const std::string& arguments) {
    return std::system(("ffmpeg -nostdin -v error -y " + arguments).c_str()) == 0;
  }
  int packets(const std::string& film, const std::string& stream) const {
    return std::atoi(run("ffprobe -v error -count_packets -select_streams " + stream +
                         " -show_entries stream=nb_read_packets -of csv=p=0 " + path(film))
                         .text.c_str());
  }

  Heard play(const std::string& player, const std::string& film) const {
    Heard heard;
    gchar* uri = gst_filename_to_uri(path(film).c_str(), nullptr);
    run_pipeline(player + " name=player uri=" + uri + " video-sink=\"fakesink sync=false\"",
                 [&heard](GstElement* pipeline) {
                   GstElement* sink = gst_element_factory_make("fakesink", nullptr);
                   g_object_set(sink, "sync", FALSE, "signal-handoffs", TRUE, nullptr);
                   g_signal_connect(sink, "handoff", G_CALLBACK(hear), &heard);
                   g_object_set(pipeline, "audio-sink", sink, nullptr);
                 });
    g_free(uri);
    return heard;
  }

  /// Flags of each stream of sound, by number of channels, as a demuxer tells them.
  std::map<int, GstStreamFlags> flags(const std::string& film) const {
    std::map<int, GstStreamFlags> found;
    run_pipeline("filesrc location=" + quoted(path(film)) + " ! matroskademux name=demux",
                 [&](GstElement* pipeline) {
                   GstElement* demux = gst_bin_get_by_name(GST_BIN(pipeline), "demux");
                   g_signal_connect(demux, "pad-added", G_CALLBACK(look_at), &found);
                   gst_object_unref(demux);
                 });
    return found;
  }

  TemporaryFolder folder;
};

TEST_F(TrackMerge, PlayersPlayTheSoundOfTheFilmAsBefore) {
  const CommandResult result = merge("film.avi", "track.flac", "felt.mkv");
  ASSERT_EQ(result.status, 0) << result.text;
  for (const char* player : {"playbin", "playbin3"}) {
    SCOPED_TRACE(player);
    const Heard before = play(player, "film.avi"), after = play(player, "felt.mkv");
    EXPECT_NE(after.caps.find("channels=(int)2"), std::string::npos) << after.caps;
    ASSERT_EQ(before.bytes.size(), 100u * 960 * 2 * 2);
    EXPECT_EQ(after.bytes, before.bytes);
  }
}

TEST_F(TrackMerge, TheTrackIsNeitherDefaultNorEnabled) {
  ASSERT_EQ(merge("film.avi", "track.flac", "felt.mkv").status, 0);
  const std::map<int, GstStreamFlags> found = flags("felt.mkv");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(found.at(2) & GST_STREAM_FLAG_SELECT);
  EXPECT_FALSE(found.at(6) & GST_STREAM_FLAG_SELECT);
  EXPECT_TRUE(found.at(6) & GST_STREAM_FLAG_UNSELECT);
  // FlagDefault and FlagEnabled of RFC 9559, of one track.
  std::ifstream file(path("felt.mkv"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::string off("\x88\x81\x00\xB9\x81\x00", 6);
  const size_t at = bytes.find(off);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(bytes.find(off, at + 1), std::string::npos);
}

TEST_F(TrackMerge, TheTrackHasNoLanguageAndTheFilmKeepsWhatItHas) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  std::ofstream(path("film.srt")) << "1\n00:00:00,100 --> 00:00:01,000\nThis & that\n";
  ASSERT_EQ(
      std::system(("ffmpeg -nostdin -v error -i " + path("film.avi") + " -i " + path("film.srt") +
                   " -map 0 -map 1 -frames:v 50 -c:v libx264 -preset ultrafast -c:a aac -c:s "
                   "srt -metadata title=Title -metadata:s:a:0 language=jpn " +
                   path("film.mkv"))
                      .c_str()),
      0);
  const CommandResult merged = merge("film.mkv", "track.flac", "felt.mkv");
  ASSERT_EQ(merged.status, 0) << merged.text;
  const std::string probed =
      run("ffprobe -v error -show_entries stream=codec_type:stream_tags=language:format_tags=title "
          "-of compact=p=0 " +
          path("felt.mkv"))
          .text;
  expect_contains(probed, "codec_type=audio|tag:language=jpn");
  expect_contains(probed, "codec_type=audio|tag:language=zxx");
  expect_contains(probed, "codec_type=subtitle");
  expect_contains(probed, "Title");
  expect_contains(
      run("ffmpeg -nostdin -v error -i " + path("felt.mkv") + " -map 0:s -f srt -").text,
      "This & that");
  const TrackNotes notes = read_track_notes(path("felt.mkv"));
  EXPECT_TRUE(notes.film.empty()) << "the track was made by hand";
  // Beside H.264 and AAC, whose parsers tell their caps later.
  expect_contains(merge("felt.mkv", "track.flac", "twice.mkv").text, "has a haptic track already");
}

/// So that the streams of a film end at times that differ by more than any queue holds.
TEST_F(TrackMerge, SoundMayBeMuchLongerOrShorterThanThePictures) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  const std::tuple<const char*, int, int> films[] = {
      // GStreamer ignores a stream of MP4 that is shorter than a fifth of the film.
      {"long.mkv", 2, 42},
      {"long.mkv", 42, 2},
      {"long.mp4", 2, 7},
  };
  for (const auto& [film, pictures_s, sound_s] : films) {
    SCOPED_TRACE(film + (": " + std::to_string(pictures_s)) + " s, sound " +
                 std::to_string(sound_s));
    ASSERT_TRUE(ffmpeg("-f lavfi -i testsrc2=s=64x48:r=5:d=" + std::to_string(pictures_s) +
                       " -f lavfi -i sine=r=48000:d=" + std::to_string(sound_s) +
                       " -c:v libx264 -preset ultrafast -c:a aac " + path(film)));
    save_track(path("long.flac"), samples(pictures_s * 1000));
    const CommandResult merged = merge(film, "long.flac", "felt.mkv");
    ASSERT_EQ(merged.status, 0) << merged.text;
    EXPECT_EQ(packets("felt.mkv", "v:0"), 5 * pictures_s);
    // The edit list of MP4 hides the packets that only begin or end the coding of the sound.
    EXPECT_NEAR(packets("felt.mkv", "a:0"), packets(film, "a:0"), 2);
    ASSERT_EQ(spidartrack("extract " + path("felt.mkv") + " " + path("out.wav")).status, 0);
    EXPECT_EQ(load_track(path("out.wav")).size(), static_cast<size_t>(pictures_s) * 1000);
  }
}

/// Their parsers know Vorbis and FLAC by what follows the first packet.
TEST_F(TrackMerge, TheTrackIsFoundBesideAnySound) {
  const std::string track = path("felt.mkv");
  for (const char* codec : {"vorbisenc", "flacenc", "lamemp3enc", "avenc_ac3", "opusenc"}) {
    SCOPED_TRACE(codec);
    run_pipeline(std::string("matroskamux name=mux ! filesink location=") + path("film.mkv") +
                 " videotestsrc num-buffers=50 pattern=ball ! "
                 "video/x-raw,width=64,height=48,framerate=25/1 ! jpegenc ! mux. "
                 "audiotestsrc num-buffers=100 samplesperbuffer=960 ! audioconvert ! "
                 "audio/x-raw,rate=48000,channels=2 ! " +
                 codec + " ! mux.");
    const CommandResult merged = merge("film.mkv", "track.wav", "felt.mkv");
    ASSERT_EQ(merged.status, 0) << merged.text;
    EXPECT_EQ(load_track(track).size(), 2000u);
    EXPECT_TRUE(read_film(track).has_track);
    expect_contains(spidartrack("info " + track).text, "the haptic track is inside the film");
    expect_contains(merge("felt.mkv", "track.wav", "twice.mkv").text, "has a haptic track already");
  }
}

/// FLV tells its streams as they come, and MP3 is known by its data only.
TEST_F(TrackMerge, SoundMayBeFoundLate) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  for (const char* codec : {"libmp3lame", "aac"}) {
    SCOPED_TRACE(codec);
    ASSERT_TRUE(ffmpeg("-i " + path("film.avi") + " -itsoffset 1 -i " + path("film.avi") +
                       " -map 0:v -map 1:a -t 2 -c:v libx264 -preset ultrafast -ar 44100 -c:a " +
                       codec + " " + path("film.flv")));
    const CommandResult merged = merge("film.flv", "track.flac", "felt.mkv");
    ASSERT_EQ(merged.status, 0) << merged.text;
    for (const char* stream : {"v:0", "a:0"}) {
      EXPECT_EQ(packets("felt.mkv", stream), packets("film.flv", stream)) << stream;
    }
  }
  ASSERT_TRUE(ffmpeg("-i " + path("film.avi") + " -an -c:v libx264 " + path("film.flv")));
  expect_contains(merge("film.flv", "track.flac", "felt.mkv").text, "has no sound");
}

TEST_F(TrackMerge, WhatIsLostIsSaid) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  ASSERT_TRUE(ffmpeg("-i " + path("film.avi") +
                     " -frames:v 50 -c:v libx264 -preset ultrafast -c:a aac " +
                     path("upright.mp4")));
  ASSERT_TRUE(ffmpeg("-i " + path("upright.mp4") + " -c copy -metadata:s:v rotate=90 " +
                     path("turned.mp4")));
  const CommandResult upright = merge("upright.mp4", "track.flac", "felt.mkv");
  EXPECT_EQ(upright.status, 0);
  EXPECT_EQ(upright.text, "");
  const CommandResult turned = merge("turned.mp4", "track.flac", "felt.mkv");
  EXPECT_EQ(turned.status, 0);
  expect_contains(turned.text, "The pictures are turned (rotate-270)");
  ASSERT_TRUE(ffmpeg("-i " + path("upright.mp4") + " -i " + path("upright.mp4") +
                     " -map 0 -map 1:v -c copy -c:v:1 png -frames:v:1 1 -disposition:v:1 "
                     "attached_pic " +
                     path("cover.mp4")));
  expect_contains(merge("cover.mp4", "track.flac", "felt.mkv").text, "The cover art is lost");
}

TEST_F(TrackMerge, TheTrackComesBackSampleBySample) {
  // Half a step of 24 bits, and what a float below 1 is rounded by.
  const double half_step = std::ldexp(1.0, -24) + std::ldexp(1.0, -25);
  save_track(path("track.hjif"), samples());
  const std::pair<const char*, double> tracks[] = {
      {"track.wav", 0}, {"track.flac", half_step}, {"track.hjif", 4.1e-4}};
  for (const auto& [track, error] : tracks) {
    SCOPED_TRACE(track);
    ASSERT_EQ(merge("film.avi", track, "felt.mkv").status, 0);
    ASSERT_EQ(spidartrack("extract " + path("felt.mkv") + " " + path("out.mka")).status, 0);
    const std::vector<TrackSample> read = load_track(path("out.mka"));
    ASSERT_EQ(read.size(), 2000u);
    EXPECT_LE(largest_difference(read, samples()), error);
  }
}

TEST_F(TrackMerge, SixConstantsStayInTheirChannels) {
  const std::vector<TrackSample> constant(2000, {0.125F, -0.25F, 0.375F, -0.5F, 0.625F, -0.75F});
  for (const char* track : {"constant.wav", "constant.flac", "constant.mka"}) {
    SCOPED_TRACE(track);
    save_track(path(track), constant);
    ASSERT_EQ(merge("film.avi", track, "felt.mkv").status, 0);
    for (const char* out : {"out.wav", "out.flac", "out.mka", "out.hjif"}) {
      ASSERT_EQ(spidartrack("extract " + path("felt.mkv") + " " + path(out)).status, 0);
      const std::vector<TrackSample> read = load_track(path(out));
      ASSERT_EQ(read.size(), constant.size()) << out;
      // All six are whole steps of every encoding.
      EXPECT_LE(largest_difference(read, constant), 1e-7) << out;
    }
  }
}

TEST_F(TrackMerge, WhatPlayersWouldMakeNoiseOfIsRefused) {
  const CommandResult silent = merge("silent.avi", "track.flac", "felt.mkv");
  EXPECT_EQ(silent.status, 1);
  expect_contains(silent.text, "has no sound");
  expect_contains(silent.text, "Leave it beside the film");
  EXPECT_FALSE(fs::exists(path("felt.mkv")));
  ASSERT_EQ(merge("film.avi", "track.flac", "felt.mkv").status, 0);
  const CommandResult twice = merge("felt.mkv", "track.flac", "twice.mkv");
  EXPECT_EQ(twice.status, 1);
  expect_contains(twice.text, "has a haptic track already");
  for (const auto& entry : fs::directory_iterator(folder.path)) {
    EXPECT_NE(entry.path().filename().string().rfind(".part-", 0), 0u) << entry.path();
  }
}

TEST_F(TrackMerge, OtherMistakesAreNamed) {
  save_track(path("long.wav"), samples(2200));
  const CommandResult other = merge("film.avi", "long.wav", "felt.mkv");
  EXPECT_EQ(other.status, 1);
  expect_contains(other.text, "another film: the track lasts 2.200 s, the film 2.000 s");
  EXPECT_EQ(merge("film.avi", "track.flac", "felt.mp4").status, 2);
  EXPECT_EQ(merge("film.avi", "film.avi", "felt.mkv").status, 1);
  expect_contains(merge("none.avi", "track.flac", "felt.mkv").text, "there is no such file");
  ASSERT_EQ(merge("film.avi", "track.flac", "felt.mkv").status, 0);
  EXPECT_EQ(merge("felt.mkv", "track.flac", "felt.mkv").status, 2);
  const CommandResult none = spidartrack("extract " + path("film.avi") + " " + path("out.wav"));
  EXPECT_EQ(none.status, 1);
  expect_contains(none.text, "2 channels");
  expect_contains(spidartrack("extract " + path("silent.avi") + " " + path("out.wav")).text,
                  "no haptic track");
}

}  // namespace
}  // namespace spidar::test::track_merge_test
