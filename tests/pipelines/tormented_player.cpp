// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/pipelines/tormented_player.h"

#include <string_view>

#include "plugin/filter/spidar_motion.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"

namespace spidar::test {
namespace {

constexpr char kPipeline[] =
    "videotestsrc name=source pattern=ball ! capsfilter name=size "
    "caps=video/x-raw,format=GRAY8,width=96,height=64,framerate=100/1 ! "
    "spidarmotion name=motion ! queue max-size-buffers=4 ! fakesink name=sink sync=true";

constexpr GstClockTime kPatience = 100 * GST_MSECOND;

/// Faults that the test has caused itself.
bool is_expected(const std::string& from, std::string_view text) {
  if (from == "motion") return text.find("does not answer") != std::string_view::npos;
  return from == "size" || from == "source";
}

GstPadProbeReturn end(GstPadProbeInfo* info, GstFlowReturn reason) {
  gst_buffer_unref(GST_PAD_PROBE_INFO_BUFFER(info));
  GST_PAD_PROBE_INFO_DATA(info) = nullptr;
  GST_PAD_PROBE_INFO_FLOW_RETURN(info) = reason;
  return GST_PAD_PROBE_HANDLED;
}

}  // namespace

TormentedPlayer::TormentedPlayer() {
  init_gstreamer();
  GError* error = nullptr;
  pipeline_ = gst_parse_launch(kPipeline, &error);
  if (!pipeline_ || error) g_error("%s", error ? error->message : "no pipeline");
  element_ = part("motion");
  bus_ = gst_element_get_bus(pipeline_);
  const auto count = [](GstBus*, GstMessage* message, gpointer self) {
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR)
      ++static_cast<TormentedPlayer*>(self)->errors_;
    return GST_BUS_PASS;
  };
  gst_bus_set_sync_handler(bus_, count, this, nullptr);
  g_object_set(element_, "haptic-trace", (folder_.path / "haptic.csv").c_str(), nullptr);
  size_ = part("size");
  GstPad* pad = gst_element_get_static_pad(size_, "src");
  const auto probe = [](GstPad* from, GstPadProbeInfo* info, gpointer self) {
    return static_cast<TormentedPlayer*>(self)->pass(from, info);
  };
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, probe, this, nullptr);
  gst_object_unref(pad);
}

TormentedPlayer::~TormentedPlayer() {
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  gst_object_unref(bus_);
  gst_object_unref(size_);
  gst_object_unref(element_);
  gst_object_unref(pipeline_);
}

filter::MotionState& TormentedPlayer::state() const {
  return gst_spidar_motion_state(GST_SPIDAR_MOTION(element_));
}

SimulatedDevice* TormentedPlayer::device() const {
  return state().feed.output.simulated();
}

GstPadProbeReturn TormentedPlayer::pass(GstPad* from, GstPadProbeInfo* info) {
  const Upstream what = upstream_.exchange(Upstream::kNothing);
  auto* buffer = gst_buffer_make_writable(GST_PAD_PROBE_INFO_BUFFER(info));
  GST_PAD_PROBE_INFO_DATA(info) = buffer;
  const GstClockTime pts = GST_BUFFER_PTS(buffer);
  switch (what) {
    case Upstream::kGapFrame:
      GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_GAP);
      break;
    case Upstream::kDiscont:
      GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_DISCONT);
      break;
    case Upstream::kNoTimestamp:
      GST_BUFFER_PTS(buffer) = GST_CLOCK_TIME_NONE;
      break;
    case Upstream::kSameAsBefore:
      GST_BUFFER_PTS(buffer) = last_pts_;
      break;
    case Upstream::kEarlier:
      GST_BUFFER_PTS(buffer) = last_pts_ - MIN(last_pts_, 100 * GST_MSECOND);
      break;
    case Upstream::kGap:
      gst_pad_push_event(from, gst_event_new_gap(pts, 20 * GST_MSECOND));
      break;
    case Upstream::kError:
      GST_ELEMENT_ERROR(size_, STREAM, DECODE, ("broken on purpose"), (nullptr));
      return end(info, GST_FLOW_ERROR);
    case Upstream::kEnd:
      return end(info, GST_FLOW_EOS);
    case Upstream::kNothing:
      break;
  }
  last_pts_ = pts;
  return GST_PAD_PROBE_OK;
}

/// A pipeline (seen in 1.22) may refuse a state when an error has just been posted.
void TormentedPlayer::set_state(GstState state) {
  const bool refused = gst_element_set_state(pipeline_, state) == GST_STATE_CHANGE_FAILURE;
  EXPECT_TRUE(!refused || errors_.exchange(0) > 0) << "no error says why";
}

bool TormentedPlayer::reaches(GstState state) const {
  GstState now = GST_STATE_VOID_PENDING;
  const GstStateChangeReturn change = gst_element_get_state(pipeline_, &now, nullptr, kPatience);
  return change == GST_STATE_CHANGE_SUCCESS && now == state;
}

bool TormentedPlayer::reaches_end_of_segment() {
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus_, kPatience, static_cast<GstMessageType>(GST_MESSAGE_SEGMENT_DONE | GST_MESSAGE_ERROR));
  if (!message) return false;
  const bool done = GST_MESSAGE_TYPE(message) == GST_MESSAGE_SEGMENT_DONE;
  if (!done) check(message);
  gst_message_unref(message);
  return done;
}

void TormentedPlayer::seek(double rate, int flags, GstClockTime start, GstClockTime stop) {
  gst_element_seek(pipeline_, rate, GST_FORMAT_TIME, static_cast<GstSeekFlags>(flags),
                   GST_SEEK_TYPE_SET, static_cast<gint64>(start), GST_SEEK_TYPE_SET,
                   static_cast<gint64>(stop));
}

void TormentedPlayer::set_caps(const std::string& text) {
  GstCaps* caps = gst_caps_from_string(text.c_str());
  g_object_set(size_, "caps", caps, nullptr);
  gst_caps_unref(caps);
}

void TormentedPlayer::check(GstMessage* message) {
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  const std::string from = GST_MESSAGE_SRC_NAME(message);
  EXPECT_TRUE(is_expected(from, error->message)) << from << ": " << error->message;
  g_error_free(error);
}

void TormentedPlayer::drain_bus() {
  while (GstMessage* message = gst_bus_pop(bus_)) {
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) check(message);
    gst_message_unref(message);
  }
}

void TormentedPlayer::stop() {
  set_state(GST_STATE_NULL);
  EXPECT_EQ(state().feed.output.session(), nullptr);
  const std::filesystem::path trace = folder_.path / "haptic.csv";
  if (!std::filesystem::exists(trace)) return;
  watch_.check_trace(trace);
  std::filesystem::remove(trace);
  // Nothing can be given to a device that is lost. And of a long trace the end may be missing,
  // where the machine was too busy to write it: the loop keeps this many rows.
  constexpr uint64_t kKept = 4096;
  if (watch_.last().device == DeviceState::kLost || watch_.last().tick > kKept) return;
  EXPECT_EQ(watch_.last().tension_N.norm(), 0) << "the player has stopped";
}

}  // namespace spidar::test
