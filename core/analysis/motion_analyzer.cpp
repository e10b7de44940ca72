// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_analyzer.h"

#include "core/analysis/frame_meter.h"
#include "core/analysis/frame_renderer.h"

namespace spidar {
namespace {

FrameMeter::Settings meter_settings(const AnalyzerSettings& settings) {
  return {settings.tracker, settings.motion == MotionKind::kMean};
}

}  // namespace

struct MotionAnalyzer::Impl {
  explicit Impl(const AnalyzerSettings& settings)
      : meter(meter_settings(settings)), renderer(settings) {}

  FrameMeter meter;
  FrameRenderer renderer;
};

MotionAnalyzer::MotionAnalyzer(const AnalyzerSettings& settings)
    : impl_(std::make_unique<Impl>(settings)) {}

MotionAnalyzer::~MotionAnalyzer() = default;

void MotionAnalyzer::configure(const AnalyzerSettings& settings) {
  impl_->renderer.configure(settings);  // validates all of them
  impl_->meter.configure(meter_settings(settings));
}

FrameAnalysis MotionAnalyzer::analyze(const ImageView& frame, int64_t running_time_ns,
                                      const FilmPlace& film) {
  return impl_->renderer.render(impl_->meter.measure(frame, running_time_ns), film);
}

std::optional<FrameAnalysis> MotionAnalyzer::repeat(int64_t running_time_ns) {
  const MeasuredFrame* const frame = impl_->meter.repeat(running_time_ns);
  if (!frame) return std::nullopt;
  return impl_->renderer.render(*frame);
}

void MotionAnalyzer::restart() {
  impl_->meter.restart();
}

}  // namespace spidar
