// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/display/motion_display.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <gst/base/gstbasetransform.h>

#include "plugin/filter/display/element_source.h"
#include "plugin/filter/frame/object_metas.h"
#include "plugin/filter/overlay/video_overlay.h"
#include "plugin/filter/reports/message_and_meta.h"

namespace spidar {

void MotionDisplay::show(const FrameReport& report, const DisplayProperties& properties,
                         const AnalyzerSettings& settings, GstVideoFrame& frame) {
  hand_.see(report, GST_VIDEO_FRAME_WIDTH(&frame), GST_VIDEO_FRAME_HEIGHT(&frame));
  const std::shared_ptr<Window> shown_in = window();
  const bool draws = properties.overlay != OverlayKind::kNone;
  const bool shown = draws || properties.attach_meta || shown_in;
  if (!report.analyzed || !shown) {
    viewer_.reset();
    return;
  }
  if (shown_in) follow_film(report);
  const VisiblePart& visible = report.part;
  const SceneView& scene = viewer_.see(report.frame, visible, report.turn);
  // Before the overlay draws into the frame, because the window draws arrows of its own.
  if (shown_in && shown_in->wants_frame()) {
    FrameFacts facts;
    facts.running_ns = report.frame.running_ns;
    facts.film = film_;
    facts.analysis_ms = 1e-6 * static_cast<double>(report.took_ns);
    facts.interval_s = 1e-9 * static_cast<double>(report.frame.interval_ns);
    facts.visible = visible;
    facts.scene = scene;
    facts.motion = settings.motion;
    facts.controller = settings.controller;
    facts.speed_px_s = controller_speed_px_s(scene.motion, settings.axes, visible.height);
    facts.click = settings.kept.click;
    facts.touch = report.touch;
    shown_in->give(frame, std::move(facts));
  }
  // Both properties may have been turned on after the buffer was prepared for them.
  if (properties.attach_meta && gst_buffer_is_writable(frame.buffer)) {
    attach_motion_meta(frame.buffer, report, scene, GST_VIDEO_FRAME_WIDTH(&frame),
                       GST_VIDEO_FRAME_HEIGHT(&frame));
    attach_object_metas(frame.buffer, report, scene, GST_VIDEO_FRAME_WIDTH(&frame),
                        GST_VIDEO_FRAME_HEIGHT(&frame));
  }
  const bool can_draw = (frame.map[0].flags & GST_MAP_WRITE) != 0;
  if (draws && can_draw) {
    const bool has_tracks = properties.overlay == OverlayKind::kTracks;
    draw_overlay(scene, has_tracks, felt_objects(scene, settings.motion, report.touch), visible,
                 properties.arrow_scale, settings.controller.max_force_N, report.touch_mark, frame);
  }
}

void MotionDisplay::begin_stream(const std::string& film) {
  film_ = {};
  film_.path = std::make_shared<const std::string>(film);
}

/// A seek is known by its length.
void MotionDisplay::follow_film(const FrameReport& report) {
  constexpr int64_t kSeek_ns = GST_SECOND;
  const int64_t now_ns = report.frame.stream_ns;
  if (now_ns < 0) {
    film_.stream_ns = -1;
    return;
  }
  const bool is_seek = std::llabs(now_ns - film_.stream_ns) > kSeek_ns;
  if (film_.stream_ns < 0 || !report.frame.has_motion_before() || is_seek) {
    film_.scene_ns = now_ns;
    gint64 length_ns = 0;
    GstPad* const sink = GST_BASE_TRANSFORM_SINK_PAD(element_);
    const bool known = gst_pad_peer_query_duration(sink, GST_FORMAT_TIME, &length_ns);
    film_.length_ns = known ? std::max<gint64>(length_ns, 0) : 0;
  }
  film_.stream_ns = now_ns;
}

std::shared_ptr<Window> MotionDisplay::window() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return window_;
}

std::shared_ptr<WindowSource> MotionDisplay::source() const {
  return make_element_source(element_, engine_, choice_);
}

void MotionDisplay::open_window() {
  if (window()) return;
  auto new_window = std::make_shared<Window>(source());
  // If another thread has opened a window meanwhile, this one closes at the end.
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!window_) window_.swap(new_window);
}

void MotionDisplay::close_window() {
  std::shared_ptr<Window> closing;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing.swap(window_);
  }
  // Here, and not where the last reference goes, which may be the streaming thread's.
  if (closing) closing->close();
}

std::string MotionDisplay::save_window(const std::string& path) {
  constexpr std::chrono::seconds kTimeout{5};
  const std::shared_ptr<Window> shown = window();
  return shown ? shown->take_picture(path, kTimeout) : "there is no debug window";
}

}  // namespace spidar
