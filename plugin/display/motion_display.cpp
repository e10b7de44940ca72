// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/display/motion_display.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <gst/base/gstbasetransform.h>

#include "plugin/display/element_source.h"
#include "plugin/frame/object_metas.h"
#include "plugin/overlay/video_overlay.h"
#include "plugin/reports/motion_meta.h"

namespace spidar {

void MotionDisplay::show(const FrameReport& report, const DisplayProperties& properties,
                         const AnalyzerSettings& settings, GstVideoFrame& frame) {
  hand_.see(report, GST_VIDEO_FRAME_WIDTH(&frame), GST_VIDEO_FRAME_HEIGHT(&frame));
  const std::shared_ptr<FrameFeed> window_feed = feed();
  const bool shown = properties.overlay || properties.attach_meta || window_feed;
  if (!report.analyzed || !shown) {
    viewer_.reset();
    return;
  }
  if (window_feed) follow_film(report);
  const VisiblePart& visible = report.part;
  const SceneView& scene = viewer_.see(report.analysis, visible, report.turn);
  // Before the overlay draws into the frame, because the window draws arrows of its own.
  if (window_feed && window_waits_) {
    FrameFacts facts;
    facts.running_ns = static_cast<int64_t>(report.running_time);
    facts.film = film_;
    facts.analysis_ms = 1e-6 * static_cast<double>(report.took_ns);
    facts.interval_s = 1e-9 * static_cast<double>(report.analysis.interval_ns);
    facts.visible = visible;
    facts.scene = scene;
    facts.settings = settings;
    facts.touch = report.touch;
    window_feed->give(frame, facts);
  }
  // Both properties may have been turned on after the buffer was prepared for them.
  if (properties.attach_meta && gst_buffer_is_writable(frame.buffer)) {
    attach_motion_meta(frame.buffer, report, scene, GST_VIDEO_FRAME_WIDTH(&frame),
                       GST_VIDEO_FRAME_HEIGHT(&frame));
    attach_object_metas(frame.buffer, report, scene, GST_VIDEO_FRAME_WIDTH(&frame),
                        GST_VIDEO_FRAME_HEIGHT(&frame));
  }
  const bool can_draw =
      (frame.map[0].flags & GST_MAP_WRITE) != 0 && !is_unpacked(*frame.info.finfo);
  if (properties.overlay && can_draw) {
    draw_overlay(scene, felt_objects(scene, settings.motion, report.touch), visible,
                 properties.arrow_scale, settings.controller.max_force_N, report.touch_mark, frame);
  }
}

void MotionDisplay::begin_stream(const std::string& film) {
  film_ = {};
  film_.path = std::make_shared<const std::string>(film);
}

/// Playback by an analysis tells nothing of a seek, which is known by its length.
void MotionDisplay::follow_film(const FrameReport& report) {
  constexpr int64_t kSeek_ns = GST_SECOND;
  if (!GST_CLOCK_TIME_IS_VALID(report.stream_time)) {
    film_.stream_ns = -1;
    return;
  }
  const auto now_ns = static_cast<int64_t>(report.stream_time);
  const bool is_seek = std::llabs(now_ns - film_.stream_ns) > kSeek_ns;
  if (film_.stream_ns < 0 || report.analysis.restarted || is_seek) {
    film_.scene_ns = now_ns;
    gint64 length_ns = 0;
    GstPad* const sink = GST_BASE_TRANSFORM_SINK_PAD(element_);
    const bool known = gst_pad_peer_query_duration(sink, GST_FORMAT_TIME, &length_ns);
    film_.length_ns = known ? std::max<gint64>(length_ns, 0) : 0;
  }
  film_.stream_ns = now_ns;
}

bool MotionDisplay::window_waits() {
  const std::shared_ptr<FrameFeed> window_feed = feed();
  window_waits_ = window_feed && window_feed->wanted();
  return window_waits_;
}

std::shared_ptr<FrameFeed> MotionDisplay::feed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return feed_;
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
  auto new_feed = std::make_shared<FrameFeed>();
  auto new_window = std::make_shared<Window>(source(), new_feed);
  // If another thread has opened a window meanwhile, this one closes at the end of the function.
  const std::lock_guard<std::mutex> lock(mutex_);
  if (window_) return;
  window_ = std::move(new_window);
  feed_ = std::move(new_feed);
}

void MotionDisplay::close_window() {
  std::shared_ptr<Window> closing;
  const std::lock_guard<std::mutex> lock(mutex_);
  closing.swap(window_);
  feed_.reset();
}

std::string MotionDisplay::save_window(const std::string& path) {
  constexpr std::chrono::seconds kTimeout{5};
  const std::shared_ptr<Window> shown = window();
  if (!shown) return "there is no debug window";
  const std::optional<Screenshot> shot = shown->screenshot(kTimeout);
  return shot ? write_png(*shot, path) : "the debug window does not answer";
}

}  // namespace spidar
