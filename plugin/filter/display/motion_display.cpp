// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/display/motion_display.h"

#include <algorithm>
#include <utility>

#include <gst/base/gstbasetransform.h>

#include "core/force/motion_rendering.h"
#include "plugin/filter/display/element_source.h"
#include "plugin/filter/reports/motion_meta.h"
#include "plugin/frame/object_metas.h"
#include "plugin/gobject/downstream.h"

namespace spidar::filter {

namespace {

/// Whether the element also receives subtitles, and draws them or writes both to a file.
bool takes_subtitles(GstElement* element) {
  GST_OBJECT_LOCK(element);
  bool takes = false;
  for (const GList* i = element->sinkpads; i; i = i->next) {
    auto* const pad = static_cast<GstPad*>(i->data);
    for (const char* begin : {"subtitle", "text", "subpicture"}) {
      takes = takes || (gst_pad_is_linked(pad) && g_str_has_prefix(GST_OBJECT_NAME(pad), begin));
    }
  }
  GST_OBJECT_UNLOCK(element);
  return takes;
}

}  // namespace

DrawnFrame MotionDisplay::drawn(const FrameReport& report, const AnalyzerSettings& settings) {
  DrawnFrame drawn;
  static_cast<FrameReport&>(drawn) = report;
  drawn.motion = settings.motion;
  drawn.controller = settings.controller;
  if (report.analyzed) drawn.click = settings.kept.click;
  const std::optional<LoopSnapshot> loop = output_.snapshot();
  if (report.touch.on && loop) drawn.touch_mark = touch_mark(report.touch, loop->last);
  drawn.has_subtitles = has_subtitles_;
  owners_.find(drawn);
  return drawn;
}

void MotionDisplay::show(const FrameReport& report, const FrameSettings& settings,
                         GstVideoFrame& frame) {
  const DisplayProperties& properties = settings.display;
  const int width = GST_VIDEO_FRAME_WIDTH(&frame), height = GST_VIDEO_FRAME_HEIGHT(&frame);
  hand_.update(report, width, height);
  const std::shared_ptr<window::Window> shown_in = window();
  const bool draws = properties.overlay != DisplayProperties::Overlay::kNone;
  if (!report.has_wrench() || !(draws || properties.attach_meta || shown_in)) {
    owners_.reset();
    return;
  }
  DrawnFrame shown = drawn(report, settings.analyzer);
  const bool draws_curve = properties.overlay == DisplayProperties::Overlay::kCurve;
  if (draws_curve) curve_.add(report.stamp.running_ns, report.frame.wrench.force_N.norm());
  if (shown_in) {
    follow_film(report);
    shown.film = film_;
    shown.speed_px_s = reference_speeds_px_s(report.frame.motion, settings.analyzer.axes,
                                             report.frame.shown_height_px)
                           .norm();
  }
  // The window gets the frame before the overlay draws into it, and draws its own arrows.
  if (shown_in && shown_in->wants_frame()) shown_in->queue_frame(frame, shown);
  // Both properties may have been turned on after the buffer was prepared for them.
  if (properties.attach_meta && gst_buffer_is_writable(frame.buffer)) {
    attach_motion_meta(frame.buffer, shown, width, height);
    attach_object_metas(frame.buffer, shown, width, height);
  }
  const bool can_draw = (frame.map[0].flags & GST_MAP_WRITE) != 0;
  if (draws && can_draw) {
    draw_overlay(shown, properties.overlay == DisplayProperties::Overlay::kPoints,
                 properties.arrow_scale, frame, draws_curve ? &curve_ : nullptr);
  }
}

void MotionDisplay::begin_stream(const std::string& film) {
  curve_ = {};
  film_ = {};
  film_.path = std::make_shared<const std::string>(film);
}

void MotionDisplay::begin_segment() {
  has_subtitles_ = is_upstream(GST_BASE_TRANSFORM_SINK_PAD(element_), takes_subtitles) ||
                   !find_path_downstream(element_, takes_subtitles).empty();
}

void MotionDisplay::follow_film(const FrameReport& report) {
  const FrameStamp& now = report.stamp;
  if (now.stream_ns < 0) return;
  const bool is_seek = std::exchange(epoch_, now.epoch) != now.epoch;
  const bool is_cut = report.analyzed && !report.frame.has_motion_before();
  if (film_.begin_ns < 0 || is_cut || is_seek) {
    film_.begin_ns = now.stream_ns;
    gint64 length_ns = 0;
    GstPad* const sink = GST_BASE_TRANSFORM_SINK_PAD(element_);
    const bool known = gst_pad_peer_query_duration(sink, GST_FORMAT_TIME, &length_ns);
    film_.length_ns = known ? std::max<gint64>(length_ns, 0) : 0;
  }
}

std::shared_ptr<window::Window> MotionDisplay::window() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return window_;
}

std::shared_ptr<window::Source> MotionDisplay::source() const {
  return make_element_source(element_, output_, no_force_, choice_, unread_);
}

void MotionDisplay::open_window() {
  if (window()) return;
  auto new_window = std::make_shared<window::Window>(source());
  // If another thread has opened a window meanwhile, `new_window` closes on return.
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!window_) window_.swap(new_window);
}

void MotionDisplay::close_window() {
  std::shared_ptr<window::Window> closing;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing.swap(window_);
  }
  // Close now: the last reference may be released in the streaming thread, which must not wait.
  if (closing) closing->close();
}

std::string MotionDisplay::save_window(const std::string& path) {
  constexpr std::chrono::seconds kTimeout{5};
  const std::shared_ptr<window::Window> shown = window();
  return shown ? shown->take_picture(path, kTimeout) : "there is no debug window";
}

}  // namespace spidar::filter
