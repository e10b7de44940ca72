// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/player.h"

#include <random>
#include <stdexcept>
#include <utility>

#include "spidar/realtime/monotonic.h"

namespace spidar::bench {
namespace {

GstElement* make(const char* factory) {
  GstElement* const element = gst_element_factory_make(factory, nullptr);
  if (element) return GST_ELEMENT(gst_object_ref_sink(element));
  throw std::runtime_error(std::string("GStreamer has no element ") + factory);
}

/// The system's clock, of which every second is kDrift_ppm too short.
GstClock* make_drifting_clock() {
  auto* const clock = static_cast<GstClock*>(g_object_new(GST_TYPE_SYSTEM_CLOCK, nullptr));
  const GstClockTime now = gst_clock_get_internal_time(clock);
  gst_clock_set_calibration(clock, now, now, 1'000'000 + kDrift_ppm, 1'000'000);
  return clock;
}

}  // namespace

Player::Player(const Scenario& scenario, const std::string& clip, const std::string& haptic_trace,
               OnShown on_shown)
    : scenario_(scenario),
      filter_(make("spidarmotion")),
      screen_(GST_ELEMENT(gst_object_ref_sink(make_screen(std::move(on_shown))))) {
  g_object_set(filter_, "haptic-trace", haptic_trace.c_str(), nullptr);
  pipeline_ = scenario.player ? make_player(clip) : make_live();
  bus_ = gst_element_get_bus(pipeline_);
  if (!scenario.drifts) return;
  GstClock* const clock = make_drifting_clock();
  gst_pipeline_use_clock(GST_PIPELINE(pipeline_), clock);
  gst_object_unref(clock);
}

Player::~Player() {
  stop();
  gst_object_unref(bus_);
  gst_object_unref(pipeline_);
  gst_object_unref(screen_);
  gst_object_unref(filter_);
}

GstElement* Player::make_player(const std::string& clip) {
  GstElement* const player = make(scenario_.player);
  char* const uri = gst_filename_to_uri(clip.c_str(), nullptr);
  g_object_set(player, "uri", uri, "video-filter", filter_, "video-sink", screen_, nullptr);
  g_free(uri);
  return player;
}

GstElement* Player::make_live() {
  GstElement* const pipeline = gst_parse_launch(
      "videotestsrc is-live=true pattern=ball ! video/x-raw,format=I420,width=1280,height=720,"
      "framerate=30000/1001 ! identity name=before",
      nullptr);
  GstElement* const before = gst_bin_get_by_name(GST_BIN(pipeline), "before");
  GstElement* const queue = gst_element_factory_make("queue", nullptr);
  gst_bin_add_many(GST_BIN(pipeline), filter_, queue, screen_, nullptr);
  gst_element_link_many(before, filter_, queue, screen_, nullptr);
  gst_object_unref(before);
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
  const auto flags = static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_KEY_UNIT);
  if (!gst_element_seek(pipeline_, scenario_.rate, GST_FORMAT_TIME, flags, GST_SEEK_TYPE_SET,
                        static_cast<gint64>(position), GST_SEEK_TYPE_NONE, 0)) {
    throw std::runtime_error("the pipeline cannot seek");
  }
}

int64_t Player::start() {
  int64_t begin_ns = monotonic_now_ns();
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
  return begin_ns;
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
