// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/player.h"

#include <random>
#include <stdexcept>
#include <utility>

#include <gst/audio/gstaudioclock.h>

#include "spidar/realtime/monotonic.h"
#include "tests/bench/skew/clip.h"
#include "tests/bench/skew/sound_card.h"

namespace spidar::bench {
namespace {

constexpr guint kPlayAudio = 1 << 1;  // GstPlayFlags is not in a public header

GstElement* make(const char* factory) {
  GstElement* const element = gst_element_factory_make(factory, nullptr);
  if (element) return GST_ELEMENT(gst_object_ref_sink(element));
  throw std::runtime_error(std::string("GStreamer has no element ") + factory);
}

}  // namespace

Player::Player(const Scenario& scenario, const std::string& clip, const std::string& haptic_trace,
               OnShown on_shown)
    : scenario_(scenario),
      filter_(make(scenario.track ? "spidarsink" : "spidarmotion")),
      screen_(GST_ELEMENT(gst_object_ref_sink(make_screen(std::move(on_shown))))) {
  g_object_set(filter_, "haptic-trace", haptic_trace.c_str(), nullptr);
  const bool live = scenario.source == Source::kTestSource || scenario.source == Source::kCamera;
  pipeline_ = scenario.track ? make_track_player(clip) : live ? make_live() : make_player(clip);
  bus_ = gst_element_get_bus(pipeline_);
}

Player::~Player() {
  stop();
  gst_object_unref(bus_);
  gst_object_unref(pipeline_);
  gst_object_unref(screen_);
  gst_object_unref(filter_);
}

GstElement* Player::make_player(const std::string& clip) {
  GstElement* const player = make(scenario_.source == Source::kPlaybin3 ? "playbin3" : "playbin");
  guint flags = 0;
  g_object_get(player, "flags", &flags, nullptr);
  flags = scenario_.sound ? flags | kPlayAudio : flags & ~kPlayAudio;
  char* const uri = gst_filename_to_uri(clip.c_str(), nullptr);
  g_object_set(player, "uri", uri, "flags", flags, "video-filter", filter_, "video-sink", screen_,
               nullptr);
  g_free(uri);
  g_object_set(player, "av-offset", static_cast<gint64>(scenario_.av_offset_ns), nullptr);
  if (scenario_.sound) g_object_set(player, "audio-sink", make_sound_card(kDrift), nullptr);
  return player;
}

GstElement* Player::make_live() {
  const std::string source =
      scenario_.source == Source::kCamera
          ? Camera::kLaunch
          : "videotestsrc is-live=true pattern=ball ! video/x-raw,format=I420,width=1280,"
            "height=720,framerate=30000/1001";
  GstElement* const pipeline =
      gst_parse_launch((source + " ! identity name=before").c_str(), nullptr);
  GstElement* const before = gst_bin_get_by_name(GST_BIN(pipeline), "before");
  GstElement* const queue = gst_element_factory_make("queue", nullptr);
  gst_bin_add_many(GST_BIN(pipeline), filter_, queue, screen_, nullptr);
  gst_element_link_many(before, filter_, queue, screen_, nullptr);
  gst_object_unref(before);
  return GST_ELEMENT(gst_object_ref_sink(pipeline));
}

GstElement* Player::make_track_player(const std::string& clip) {
  std::string launch =
      "filesrc location=\"" + clip +
      "\" ! avidemux name=film film.video_0 ! queue ! vp8dec ! identity name=video "
      "filesrc location=\"" +
      track_of(clip) + "\" ! wavparse ! identity name=track";
  if (scenario_.sound) launch += " film.audio_0 ! queue ! identity name=sound";
  GstElement* const pipeline = gst_parse_launch(launch.c_str(), nullptr);
  const auto end_with = [pipeline](const char* name, GstElement* sink) {
    GstElement* const end = gst_bin_get_by_name(GST_BIN(pipeline), name);
    gst_bin_add(GST_BIN(pipeline), sink);
    gst_element_link(end, sink);
    gst_object_unref(end);
  };
  end_with("video", screen_);
  end_with("track", filter_);
  if (scenario_.sound) end_with("sound", make_sound_card(kDrift));
  return GST_ELEMENT(gst_object_ref_sink(pipeline));
}

void Player::set_state(GstState state) {
  gst_element_set_state(pipeline_, state);
  await_state();
}

void Player::await_state() {
  constexpr GstClockTime kPatience = 20 * GST_SECOND;
  const GstStateChangeReturn result = gst_element_get_state(pipeline_, nullptr, nullptr, kPatience);
  take_messages(0);  // has the reason
  if (result == GST_STATE_CHANGE_FAILURE || result == GST_STATE_CHANGE_ASYNC) {
    throw std::runtime_error("the pipeline does not get ready to play");
  }
}

void Player::seek(GstClockTime position) {
  // A track has no key frames: picture and track would not go on from the same place.
  const auto flags = static_cast<GstSeekFlags>(
      GST_SEEK_FLAG_FLUSH | (scenario_.track ? GST_SEEK_FLAG_ACCURATE : GST_SEEK_FLAG_KEY_UNIT));
  if (!gst_element_seek(pipeline_, scenario_.rate, GST_FORMAT_TIME, flags, GST_SEEK_TYPE_SET,
                        static_cast<gint64>(position), GST_SEEK_TYPE_NONE, 0)) {
    throw std::runtime_error("the pipeline cannot seek");
  }
}

int64_t Player::start() {
  int64_t begin_ns = monotonic_now_ns();
  if (scenario_.source == Source::kCamera) {
    gst_element_set_state(pipeline_, GST_STATE_PLAYING);  // prerolls with the camera's first frame
    GstElement* const appsrc = gst_bin_get_by_name(GST_BIN(pipeline_), "camera");
    camera_ = std::make_unique<Camera>(appsrc);
    gst_object_unref(appsrc);
    await_state();
    return begin_ns;
  }
  set_state(GST_STATE_PAUSED);
  if (scenario_.rate != 1) {
    seek(0);
    await_state();
  }
  set_state(GST_STATE_PLAYING);
  std::mt19937 random(1);
  std::uniform_int_distribution<GstClockTime> position(0, 2 * GST_SECOND);
  for (int n = 0; n < scenario_.seeks; ++n) {
    play_for(0.02);
    seek(position(random));
    begin_ns = monotonic_now_ns();
    await_state();
  }
  check_clock();
  return begin_ns;
}

void Player::check_clock() const {
  GstClock* const clock = gst_element_get_clock(pipeline_);
  const bool of_sound = clock && GST_IS_AUDIO_CLOCK(clock);
  if (clock) gst_object_unref(clock);
  if (of_sound != scenario_.sound) throw std::runtime_error("not the clock that was to be");
}

void Player::play_for(double seconds) {
  const int64_t end_ns = monotonic_now_ns() + static_cast<int64_t>(1e9 * seconds);
  for (int64_t left_ns; (left_ns = end_ns - monotonic_now_ns()) > 0;) {
    take_messages(static_cast<GstClockTime>(left_ns));
  }
}

void Player::take_messages(GstClockTime timeout) {
  constexpr auto kTypes =
      static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS | GST_MESSAGE_LATENCY);
  while (GstMessage* const message = gst_bus_timed_pop_filtered(bus_, timeout, kTypes)) {
    timeout = 0;
    const GstMessageType type = GST_MESSAGE_TYPE(message);
    std::string text = "the clip is too short";
    if (type == GST_MESSAGE_ERROR) {
      GError* error = nullptr;
      gst_message_parse_error(message, &error, nullptr);
      text = error->message;
      g_error_free(error);
    }
    gst_message_unref(message);
    if (type != GST_MESSAGE_LATENCY) throw std::runtime_error(text);
    gst_bin_recalculate_latency(GST_BIN(pipeline_));
  }
}

void Player::stop() {
  camera_.reset();
  gst_element_set_state(pipeline_, GST_STATE_NULL);
}

uint64_t Player::dropped() const {
  GstStructure* stats = nullptr;
  g_object_get(screen_, "stats", &stats, nullptr);
  guint64 dropped = 0;
  gst_structure_get_uint64(stats, "dropped", &dropped);
  gst_structure_free(stats);
  return dropped;
}

std::string Player::scheduling() const {
  GstStructure* stats = nullptr;
  g_object_get(filter_, "stats", &stats, nullptr);
  const std::string scheduling = gst_structure_get_string(stats, "scheduling");
  gst_structure_free(stats);
  return scheduling;
}

}  // namespace spidar::bench
