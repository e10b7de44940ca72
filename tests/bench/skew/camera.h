// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A source whose frames come like those of a camera.
#pragma once

#include <atomic>
#include <thread>

#include <gst/gst.h>

namespace spidar::bench {

/// Feeds a live appsrc like v4l2src: a frame has the time at which its exposure began, and comes
/// one frame later and up to 3 ms more, by chance. A square moves to and fro.
class Camera {
 public:
  static constexpr const char* kLaunch =
      "appsrc name=camera is-live=true format=time min-latency=33366666 "
      "caps=video/x-raw,format=I420,width=1280,height=720,framerate=30000/1001";

  /// `appsrc`: the one of kLaunch; its pipeline plays, and ends after this object.
  explicit Camera(GstElement* appsrc);
  ~Camera();
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

 private:
  void run();

  GstElement* const appsrc_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace spidar::bench
