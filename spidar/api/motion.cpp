// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <stdexcept>

#include <gst-spidar/motion.h>

#include "core/analysis/motion_analyzer.h"
#include "spidar/api/vectors.h"

namespace gst_spidar {
inline namespace v0 {
namespace {

spidar::ControllerKind kind_of(Controller controller) {
  switch (controller) {
    case Controller::kLinear:
      return spidar::ControllerKind::kLinear;
    case Controller::kNonlinear:
      return spidar::ControllerKind::kNonlinear;
    case Controller::kAdaptive:
      return spidar::ControllerKind::kAdaptive;
  }
  throw std::invalid_argument("there is no such controller");
}

spidar::MotionKind kind_of(FeltMotion motion) {
  switch (motion) {
    case FeltMotion::kMean:
      return spidar::MotionKind::kMean;
    case FeltMotion::kObject:
      return spidar::MotionKind::kObject;
    case FeltMotion::kCamera:
      return spidar::MotionKind::kCamera;
    case FeltMotion::kObjects:
      return spidar::MotionKind::kObjects;
  }
  throw std::invalid_argument("there is no such motion");
}

}  // namespace

struct __attribute__((visibility("hidden"))) MotionToWrench::Impl {
  /// Throws, and changes nothing, when a setting is out of range.
  void configure(const spidar::AnalyzerSettings& wanted) {
    analyzer.configure(wanted);
    settings = wanted;
  }

  spidar::AnalyzerSettings settings;
  spidar::MotionAnalyzer analyzer;
};

MotionToWrench::MotionToWrench() : impl_(std::make_unique<Impl>()) {}
MotionToWrench::~MotionToWrench() = default;
MotionToWrench::MotionToWrench(MotionToWrench&& other) noexcept = default;
MotionToWrench& MotionToWrench::operator=(MotionToWrench&& other) noexcept = default;

MotionResult MotionToWrench::analyze(const GreyPicture& picture, std::chrono::nanoseconds time) {
  const spidar::FrameAnalysis frame = impl_->analyzer.analyze(from_api(picture), time.count());
  MotionResult result;
  result.wrench = to_api(frame.wrench);
  result.velocity_x_px_s = frame.motion.velocity_px_s.x();
  result.velocity_y_px_s = frame.motion.velocity_px_s.y();
  result.growth_1_s = frame.motion.growth_1_s;
  result.roll_rad_s = frame.motion.roll_rad_s;
  result.has_picture_before = !frame.restarted;
  return result;
}

void MotionToWrench::restart() {
  impl_->analyzer.restart();
}

void MotionToWrench::set_controller(Controller controller) {
  spidar::AnalyzerSettings settings = impl_->settings;
  settings.controller.kind = kind_of(controller);
  impl_->configure(settings);
}

void MotionToWrench::set_motion(FeltMotion motion) {
  spidar::AnalyzerSettings settings = impl_->settings;
  settings.motion = kind_of(motion);
  impl_->configure(settings);
}

void MotionToWrench::set_max_force(double max_force_N) {
  spidar::AnalyzerSettings settings = impl_->settings;
  settings.controller.max_force_N = max_force_N;
  impl_->configure(settings);
}

void MotionToWrench::set_pointer(double x, double y) {
  spidar::AnalyzerSettings settings = impl_->settings;
  settings.pointer = {x, y};
  impl_->configure(settings);
}

void MotionToWrench::set_gains(double depth, double roll) {
  spidar::AnalyzerSettings settings = impl_->settings;
  settings.axes = {depth, roll};
  impl_->configure(settings);
}

void MotionToWrench::set_alpha(double alpha_s_px) {
  spidar::AnalyzerSettings settings = impl_->settings;
  settings.controller.alpha_s_px = alpha_s_px;
  impl_->configure(settings);
}

}  // namespace v0
}  // namespace gst_spidar
