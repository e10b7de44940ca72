// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <mutex>
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

spidar::AnalyzerSettings settings_of(const MotionSettings& settings) {
  spidar::AnalyzerSettings result;
  result.controller.kind = kind_of(settings.controller);
  result.motion = kind_of(settings.motion);
  result.controller.max_force_N = settings.max_force_N;
  result.controller.alpha_s_px = settings.alpha_s_px;
  result.pointer = {settings.pointer_x, settings.pointer_y};
  result.axes = {settings.depth_gain, settings.roll_gain};
  return result;
}

}  // namespace

struct __attribute__((visibility("hidden"))) MotionToWrench::Impl {
  std::mutex calls;  // one at a time
  spidar::MotionAnalyzer analyzer{settings_of({})};
};

MotionToWrench::MotionToWrench() : impl_(std::make_unique<Impl>()) {}
MotionToWrench::~MotionToWrench() = default;
MotionToWrench::MotionToWrench(MotionToWrench&& other) noexcept = default;
MotionToWrench& MotionToWrench::operator=(MotionToWrench&& other) noexcept = default;

MotionResult MotionToWrench::analyze(const GreyPicture& picture, std::chrono::nanoseconds time) {
  const std::lock_guard<std::mutex> alone(impl_->calls);
  const spidar::Frame& frame = impl_->analyzer.analyze(from_api(picture), time.count());
  MotionResult result;
  result.wrench = to_api(frame.wrench);
  result.velocity_x_px_s = frame.motion.velocity_px_s.x();
  result.velocity_y_px_s = frame.motion.velocity_px_s.y();
  result.growth_1_s = frame.motion.growth_1_s;
  result.roll_rad_s = frame.motion.roll_rad_s;
  result.has_picture_before = frame.has_motion_before();
  return result;
}

void MotionToWrench::restart() {
  const std::lock_guard<std::mutex> alone(impl_->calls);
  impl_->analyzer.restart();
}

void MotionToWrench::configure(const MotionSettings& settings) {
  const std::lock_guard<std::mutex> alone(impl_->calls);
  impl_->analyzer.configure(settings_of(settings));
}

}  // namespace v0
}  // namespace gst_spidar
