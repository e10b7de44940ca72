// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/player/player.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace {

constexpr std::array<double, 7> kSpeeds{0.25, 0.5, 0.75, 1, 1.5, 2, 4};
constexpr size_t kUsual = 3;
/// More than the frames in a queue before the sink.
constexpr size_t kMostForces = 256;

std::string minutes(gint64 time) {
  char text[32];
  const gint64 hundredths = std::max<gint64>(time, 0) / (10 * GST_MSECOND);
  std::snprintf(text, sizeof(text), "%d:%02d.%02d", static_cast<int>(hundredths / 6000),
                static_cast<int>(hundredths / 100 % 60), static_cast<int>(hundredths % 100));
  return text;
}

}  // namespace

Player::Player(const std::string& uri, bool headless)
    : motion_(make_filter()),
      screen_(open_screen(headless)),
      playbin_(make_player(uri, motion_, screen_)),
      bus_(gst_element_get_bus(playbin_)),
      speed_(kUsual) {}

Player::~Player() {
  gst_element_set_state(playbin_, GST_STATE_NULL);
  gst_object_unref(bus_);
  gst_object_unref(playbin_);
}

void Player::play() {
  gst_element_set_state(playbin_, GST_STATE_PLAYING);
  settle();
}

/// A live source never prerolls, and a source on a network takes long.
void Player::settle() {
  gst_element_get_state(playbin_, nullptr, nullptr, 5 * GST_SECOND);
}

gint64 Player::position() const {
  gint64 position = 0;
  gst_element_query_position(playbin_, GST_FORMAT_TIME, &position);
  return position;
}

void Player::seek(gint64 position) {
  gst_element_seek(playbin_, kSpeeds[speed_], GST_FORMAT_TIME,
                   static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE),
                   GST_SEEK_TYPE_SET, std::max<gint64>(position, 0), GST_SEEK_TYPE_NONE, 0);
  settle();
}

void Player::act(const Action& action) {
  switch (action.command) {
    case Command::kPause:
      paused_ = !paused_;
      gst_element_set_state(playbin_, paused_ ? GST_STATE_PAUSED : GST_STATE_PLAYING);
      settle();
      break;
    case Command::kSeek:
      seek(position() + action.value * static_cast<gint64>(GST_SECOND));
      break;
    case Command::kSpeed: {
      const auto wanted = static_cast<int>(speed_) + action.value;
      speed_ = static_cast<size_t>(std::clamp(wanted, 0, static_cast<int>(kSpeeds.size()) - 1));
      seek(position());
      break;
    }
    case Command::kLoop:
      loop_ = !loop_;
      break;
    case Command::kStep:
      if (!paused_) act({Command::kPause, 0});
      gst_element_send_event(screen_.element,
                             gst_event_new_step(GST_FORMAT_BUFFERS, 1, 1, TRUE, FALSE));
      settle();
      break;
    case Command::kForce:
      force_ = !force_;
      g_object_set(motion_, "mute", !force_, nullptr);
      break;
    case Command::kDelay:
      delay_ms_ = action.value;
      g_object_set(motion_, "ts-offset", delay_ms_ * static_cast<gint64>(GST_MSECOND), nullptr);
      break;
    case Command::kNone:
    case Command::kQuit:
      break;
  }
}

bool Player::again() {
  if (loop_) seek(0);
  return loop_;
}

void Player::note(const GstStructure* message) {
  FrameForce frame;
  if (!message || !gst_structure_has_name(message, "spidar-motion") ||
      !gst_structure_get(message, "stream-time", G_TYPE_UINT64, &frame.stream_time, "force-x",
                         G_TYPE_DOUBLE, &frame.force_N[0], "force-y", G_TYPE_DOUBLE,
                         &frame.force_N[1], "force-z", G_TYPE_DOUBLE, &frame.force_N[2], nullptr)) {
    return;
  }
  // The frames from the previous place are useless after a seek.
  if (!forces_.empty() && frame.stream_time < forces_.back().stream_time) forces_.clear();
  forces_.push_back(frame);
  if (forces_.size() > kMostForces) forces_.pop_front();
}

std::array<double, 3> Player::force_N() const {
  const auto shown = static_cast<GstClockTime>(std::max<gint64>(position(), 0));
  while (forces_.size() > 1 && forces_[1].stream_time <= shown) forces_.pop_front();
  if (paused_ || !force_ || forces_.empty() || forces_.front().stream_time > shown) return {};
  return forces_.front().force_N;
}

double Player::max_force_N() const {
  double max_force_N = 0;
  g_object_get(motion_, "max-force", &max_force_N, nullptr);
  return max_force_N;
}

std::string Player::status() const {
  gint64 duration = 0;
  gst_element_query_duration(playbin_, GST_FORMAT_TIME, &duration);
  char text[64];
  std::snprintf(text, sizeof(text), ", %gx, %s%s, force %s, delay %d ms", kSpeeds[speed_],
                paused_ ? "paused" : "playing", loop_ ? ", loop" : "", force_ ? "on" : "off",
                delay_ms_);
  return minutes(position()) + " / " + minutes(duration) + text;
}
