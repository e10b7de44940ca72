#include "core/motion_analyzer.h"

#include <optional>

#include "core/tracking/opencv_tracker.h"

namespace spidar {

struct MotionAnalyzer::Impl {
  explicit Impl(const AnalyzerSettings& given)
      : settings(given), tracker(given.tracker), controller(make_controller(given.controller)) {
    validate(given.axes);
  }

  AnalyzerSettings settings;
  OpenCvTracker tracker;
  MotionEstimator motion;
  std::unique_ptr<GainController> controller;
  std::optional<int64_t> last_running_time_ns;
};

MotionAnalyzer::MotionAnalyzer(const AnalyzerSettings& settings)
    : impl_(std::make_unique<Impl>(settings)) {}

MotionAnalyzer::~MotionAnalyzer() = default;

void MotionAnalyzer::configure(const AnalyzerSettings& settings) {
  validate(settings.tracker);
  validate(settings.controller);
  validate(settings.axes);
  impl_->tracker.configure(settings.tracker);
  if (settings.controller.kind == impl_->settings.controller.kind) {
    impl_->controller->configure(settings.controller);
  } else {
    impl_->controller = make_controller(settings.controller);
  }
  impl_->settings = settings;
}

FrameAnalysis MotionAnalyzer::analyze(const ImageView& frame, int64_t running_time_ns) {
  if (impl_->last_running_time_ns && running_time_ns <= *impl_->last_running_time_ns) restart();
  const std::optional<int64_t> last_ns = impl_->last_running_time_ns;
  const TrackedFrame& tracked = impl_->tracker.track(frame);
  impl_->last_running_time_ns = running_time_ns;

  FrameAnalysis analysis;
  analysis.features = tracked.features;
  analysis.restarted = tracked.restarted || !last_ns;
  if (analysis.restarted) {
    impl_->motion.reset();
    return analysis;
  }

  analysis.interval_ns = running_time_ns - *last_ns;
  const SceneMotion scene = impl_->motion.estimate(impl_->settings.motion, tracked.tracks,
                                                   frame.width, frame.height, analysis.interval_ns);
  analysis.motion = scene.felt;
  analysis.model = scene.model;
  analysis.objects = scene.objects;
  analysis.tracks = &tracked.tracks;
  analysis.background = scene.background;
  analysis.objects_seen = scene.objects_seen;
  analysis.wrench =
      render_motion(*impl_->controller, analysis.motion, impl_->settings.axes, frame.height);
  return analysis;
}

void MotionAnalyzer::restart() {
  impl_->tracker.restart();
  impl_->controller->reset();
  impl_->last_running_time_ns.reset();
}

}  // namespace spidar
