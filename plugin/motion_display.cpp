#include "plugin/motion_display.h"

#include "plugin/overlay/video_overlay.h"

namespace spidar {

void MotionDisplay::show(const FrameReport& report, const DisplayProperties& properties,
                         double max_force_N, GstVideoFrame& frame) {
  if (!properties.overlay || !report.analyzed) {
    viewer_.reset();
    return;
  }
  const VisiblePart visible = visible_part(frame);
  const SceneView& scene = viewer_.see(report.analysis, visible);
  // The property may have been turned on after the frame was mapped.
  if ((frame.map[0].flags & GST_MAP_WRITE) != 0) {
    draw_overlay(scene, visible, properties.arrow_scale, max_force_N, frame);
  }
}

}  // namespace spidar
