// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A film whose picture is touched by a hand that the test moves.
#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include <gst/video/video.h>

#include "plugin/filter/spidar_motion.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/tick_trace.h"
#include "tests/pipelines/stepped_pipeline.h"

namespace spidar::test {

inline std::string touched_film(const std::string& source, const std::string& properties,
                                int width = 320, int height = 240) {
  return "videotestsrc name=source " + source +
         " ! video/x-raw,format=GRAY8,width=" + std::to_string(width) +
         ",height=" + std::to_string(height) + ",framerate=25/1 ! spidarmotion name=motion " +
         properties + " ! fakesink name=sink sync=true enable-last-sample=true";
}

/// A pipeline that plays, ticked every millisecond.
class Touched {
 public:
  explicit Touched(const std::string& launch) : pipeline(launch) {
    pipeline.set_state(GST_STATE_PLAYING);
    device_ =
        gst_spidar_motion_state(GST_SPIDAR_MOTION(pipeline.element())).feed.output.simulated();
  }

  void hold(double x_m, double y_m, double z_m) {
    Pose pose;
    pose.position_m = {x_m, y_m, z_m};
    device_->set_hand(pose);
  }
  FeltState felt() const { return device_->felt(); }

  /// Shows this number of frames.
  void play(int frames) {
    for (int n = 0; n < frames; ++n) {
      const GstClockTime next = pipeline.await();
      while (pipeline.now() + GST_MSECOND < next) see(pipeline.idle(GST_MSECOND));
      see(pipeline.step());
    }
    pipeline.await();
  }
  /// Lets this number of milliseconds pass without a new frame.
  void wait(int ticks) {
    for (int n = 0; n < ticks; ++n) see(pipeline.idle(GST_MSECOND));
  }

  const TickRecord& last() const { return rows_; }
  /// Largest motion of the grip since the last call.
  double fastest_m_s() { return std::exchange(fastest_m_s_, 0.0); }
  const std::string& trace() const { return trace_; }

  /// Of the frame that is on the screen: a pixel at a fraction of width and height.
  double luma(double x, double y) const {
    GstSample* sample = nullptr;
    g_object_get(pipeline.sink(), "last-sample", &sample, nullptr);
    GstVideoInfo info;
    gst_video_info_from_caps(&info, gst_sample_get_caps(sample));
    GstMapInfo map;
    gst_buffer_map(gst_sample_get_buffer(sample), &map, GST_MAP_READ);
    const int column = std::min(static_cast<int>(x * info.width), info.width - 1);
    const int row = std::min(static_cast<int>(y * info.height), info.height - 1);
    const double value = map.data[row * info.stride[0] + column];
    gst_buffer_unmap(gst_sample_get_buffer(sample), &map);
    gst_sample_unref(sample);
    return value;
  }

  SteppedPipeline pipeline;

 private:
  void see(const TickRecord& record) {
    rows_ = record;
    append_row(record, trace_);
    fastest_m_s_ = std::max(fastest_m_s_, device_->felt().velocity_m_s.norm());
  }

  SimulatedDevice* device_;
  TickRecord rows_;
  double fastest_m_s_ = 0;
  std::string trace_;
};

}  // namespace spidar::test
