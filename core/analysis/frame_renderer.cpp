// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/frame_renderer.h"

#include <algorithm>
#include <stdexcept>

#include "core/force/motion_bounds.h"
#include "core/force/motion_rendering.h"

namespace spidar {
namespace {

/// The object of which motion=object is felt; null when there is none.
const MovingObject* dominant(const MeasuredFrame& frame) {
  const auto found =
      std::find_if(frame.objects.begin(), frame.objects.end(),
                   [&](const MovingObject& object) { return object.id == frame.dominant; });
  return found == frame.objects.end() ? nullptr : &*found;
}

/// The id of the object whose motion is felt; 0 when it is none, or not that of one object. An
/// object that rests is felt as rest.
uint32_t felt_object(const MeasuredFrame& frame, MotionKind kind) {
  const MovingObject* const object = dominant(frame);
  if (kind != MotionKind::kObject || !object) return 0;
  const bool is_lost = object->tracks == 0 && object->relative_px_s.isZero(0);
  return is_lost ? 0 : object->id;
}

/// The same motion when it takes 1 / `factor` of the time.
ImageMotion faster(ImageMotion motion, double factor) {
  motion.velocity_px_s *= factor;
  motion.growth_1_s *= factor;
  motion.roll_rad_s *= factor;
  motion.noise_px_s *= factor;
  return motion;
}

}  // namespace

AnalyzerSettings paper_settings() {
  AnalyzerSettings settings;
  settings.motion = MotionKind::kMean;
  settings.filter.min_cutoff_Hz = 0;
  settings.controller.kind = ControllerKind::kNonlinear;
  return settings;
}

void validate(const AnalyzerSettings& settings) {
  validate(settings.tracker);
  validate(settings.controller);
  validate(settings.filter);
  validate(settings.axes);
  if (!settings.pointer.allFinite()) {
    throw std::invalid_argument("the pointer's coordinates must be finite");
  }
}

FrameRenderer::FrameRenderer(const AnalyzerSettings& settings)
    : settings_(settings), controller_(make_controller(settings.controller)) {
  validate(settings);
}

void FrameRenderer::configure(const AnalyzerSettings& settings) {
  validate(settings);
  if (settings.controller.kind == settings_.controller.kind) {
    controller_->configure(settings.controller);
  } else {
    controller_ = make_controller(settings.controller);
  }
  settings_ = settings;
}

ImageMotion FrameRenderer::choose(const MeasuredFrame& frame) const {
  switch (settings_.motion) {
    case MotionKind::kMean:
      return frame.mean;
    case MotionKind::kCamera:
      if (!frame.background) return {};
      return camera_motion(*frame.background, frame.votes,
                           static_cast<double>(frame.interval_ns) * 1e-9);
    case MotionKind::kObjects: {
      const Eigen::Vector2d pointer_px((settings_.pointer.x() - 0.5) * frame.width,
                                       (settings_.pointer.y() - 0.5) * frame.height);
      return motion_at_pointer(frame.objects, pointer_px, frame.height);
    }
    case MotionKind::kObject:
      break;
  }
  const MovingObject* const object = dominant(frame);
  return object ? motion_of(*object) : ImageMotion();
}

/// The result that continues while the picture is repeated.
FrameAnalysis FrameRenderer::wait() const {
  FrameAnalysis analysis = latest_;
  analysis.restarted = false;
  analysis.same_picture = true;
  // Zero motion has nothing to continue.
  analysis.repeated = !analysis.wrench.stacked().isZero(0);
  return analysis;
}

FrameAnalysis FrameRenderer::render(const MeasuredFrame& frame) {
  if (frame.anew) {
    controller_->reset();
    latest_ = {};
  }
  if (frame.shown == Shown::kWaiting) return wait();
  FrameAnalysis analysis;
  analysis.width = frame.width;
  analysis.height = frame.height;
  analysis.features = frame.features;
  analysis.restarted = frame.shown == Shown::kFirst;
  if (analysis.restarted) {
    lost_frames_.reset();
    filter_.reset();
    fade_.reset();
    return latest_ = analysis;
  }
  analysis.interval_ns = frame.interval_ns;
  analysis.same_picture = frame.shown != Shown::kOther;
  analysis.tracks = frame.tracks;
  if (frame.background) {
    analysis.model = frame.background->model.kind;
    analysis.background = &*frame.background;
    if (settings_.motion != MotionKind::kCamera) {
      analysis.objects = static_cast<int>(frame.objects.size());
      analysis.object_list = &frame.objects;
    }
  }
  ImageMotion felt = choose(frame);
  if (frame.shown == Shown::kSame) {
    filter_.stop();
    fade_.reset();
    const int tracked = felt.tracked;
    felt = ImageMotion();
    felt.tracked = tracked;
  }
  felt = faster(felt, lost_frames_.correction(frame.interval_ns, frame.shown_for_ns,
                                              felt.velocity_px_s.norm()));
  const double interval_s = static_cast<double>(frame.interval_ns) * 1e-9;
  analysis.motion = bound_motion(felt, frame.width, interval_s);
  // The filter does not mix the motions of two objects.
  if (fade_.turn_to(felt_object(frame, settings_.motion))) filter_.reset();
  const ImageMotion steady =
      filter_.filter(analysis.motion, frame.height, interval_s, settings_.filter);
  const Wrench wanted =
      render_motion(*controller_, steady, settings_.axes, frame.height, interval_s);
  analysis.wrench = fade_.fade(wanted, interval_s);
  return latest_ = analysis;
}

}  // namespace spidar
