// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <mutex>
#include <stdexcept>

#include <gst-spidar/motion.h>

#include "core/analysis/motion_analyzer.h"
#include "spidar/api/of_this_process.h"
#include "spidar/api/vectors.h"

namespace gst_spidar {
inline namespace v0 {
namespace {

spidar::ControlLaw law_of(Controller controller) {
  switch (controller) {
    case Controller::kLinear:
      return spidar::ControlLaw::kLinear;
    case Controller::kNonlinear:
      return spidar::ControlLaw::kNonlinear;
    case Controller::kAdaptive:
      return spidar::ControlLaw::kAdaptive;
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

// The installed header motion.h repeats the value, because it cannot include kDefaultForce_N.
static_assert(MotionSettings{}.max_force_N == spidar::kDefaultForce_N);

spidar::AnalyzerSettings settings_of(const MotionSettings& settings) {
  spidar::AnalyzerSettings result;
  result.area.kind = spidar::AreaSetting::Kind::kWhole;  // the caller knows what the pictures show
  result.controller.law = law_of(settings.controller);
  result.motion = kind_of(settings.motion);
  result.controller.max_force_N = settings.max_force_N;
  result.controller.alpha_s_px = settings.alpha_s_px;
  result.pointer = {settings.pointer_x, settings.pointer_y};
  result.axes = {settings.depth_gain, settings.roll_gain};
  return result;
}

struct Analysis {
  std::mutex calls;  // serialises the calls
  spidar::MotionAnalyzer analyzer{settings_of({})};
};

}  // namespace

struct __attribute__((visibility("hidden"))) MotionToWrench::Impl {
  /// Throws std::runtime_error after fork() in the child.
  Locked<Analysis> alone() const {
    Analysis* const mine = analysis.get();
    if (!mine) {
      throw std::runtime_error(
          "this was made by the process that this one is a copy of (fork): make one in this one");
    }
    return Locked(*mine);
  }

  const OfThisProcess<Analysis> analysis;
};

MotionToWrench::MotionToWrench() : impl_(std::make_unique<Impl>()) {}
MotionToWrench::~MotionToWrench() = default;
MotionToWrench::MotionToWrench(MotionToWrench&& other) noexcept = default;
MotionToWrench& MotionToWrench::operator=(MotionToWrench&& other) noexcept = default;

MotionResult MotionToWrench::analyze(const GreyPicture& picture, std::chrono::nanoseconds time) {
  const auto alone = impl_->alone();
  const spidar::Frame& frame = alone->analyzer.analyze(from_api(picture), time.count());
  MotionResult result;
  result.wrench = to_api(frame.wrench);
  result.velocity_x_px_s = frame.motion.velocity_px_s.x();
  result.velocity_y_px_s = frame.motion.velocity_px_s.y();
  result.growth_1_s = frame.motion.growth_1_s;
  result.roll_rad_s = frame.motion.roll_rad_s;
  result.has_picture_before = frame.has_motion_before();
  return result;
}

void MotionToWrench::reset() {
  if (impl_->analysis.get()) impl_->alone()->analyzer.reset();
}

void MotionToWrench::configure(const MotionSettings& settings) {
  impl_->alone()->analyzer.configure(settings_of(settings));
}

}  // namespace v0
}  // namespace gst_spidar
