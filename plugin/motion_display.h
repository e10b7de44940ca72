/// Where a frame's motion and force are shown besides being felt.
#pragma once

#include <gst/video/video.h>

#include "plugin/display_properties.h"
#include "plugin/motion_engine.h"
#include "plugin/overlay/scene_view.h"

namespace spidar {

/// One element's overlay. Streaming thread.
class MotionDisplay {
 public:
  /// `report` as process() just gave it of `frame`, which is mapped for writing when the overlay is
  /// on.
  void show(const FrameReport& report, const DisplayProperties& properties, double max_force_N,
            GstVideoFrame& frame);

 private:
  SceneViewer viewer_;
};

}  // namespace spidar
