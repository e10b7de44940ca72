// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_analyzer.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "core/field/reduced_frame.h"
#include "core/force/motion_bounds.h"
#include "core/force/wrench_fade.h"
#include "core/motion/cadence.h"
#include "core/motion/motion_estimator.h"
#include "core/tracking/opencv_tracker.h"

namespace spidar {
namespace {

/// Number of points in addition to the field of blocks, by quality.
constexpr int kFewPoints = 64;
constexpr int kManyPoints = 200;

/// Checks settings that the parts of the analyzer do not check themselves.
void validate_rest(const AnalyzerSettings& settings) {
  validate(settings.filter);
  validate(settings.axes);
  if (!settings.pointer.allFinite()) {
    throw std::invalid_argument("the pointer's coordinates must be finite");
  }
}

Cadence::Picture picture_of(bool repeated, bool alike) {
  if (repeated) return Cadence::Picture::kSame;
  return alike ? Cadence::Picture::kAlike : Cadence::Picture::kOther;
}

/// The id of the object whose motion is felt; 0 when it is none, or not that of one object. An
/// object that rests is felt as rest.
uint32_t felt_object(const SceneMotion& scene, MotionKind kind) {
  if (kind != MotionKind::kObject || !scene.dominant) return 0;
  const bool is_lost = scene.dominant->tracks == 0 && scene.dominant->relative_px_s.isZero(0);
  return is_lost ? 0 : scene.dominant->id;
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

struct MotionAnalyzer::Impl {
  explicit Impl(const AnalyzerSettings& given)
      : settings(given), tracker(given.tracker), controller(make_controller(given.controller)) {
    validate_rest(given);
  }

  FieldPoints::Settings field_points() const {
    const TrackerQuality quality = settings.tracker.quality;
    return {std::min(settings.tracker.max_features,
                     quality == TrackerQuality::kFine ? kManyPoints : kFewPoints),
            quality != TrackerQuality::kFast};
  }

  AnalyzerSettings settings;
  ReducedFrame reduced;
  OpenCvTracker tracker;   // for kMean
  MotionEstimator motion;  // for all other kinds
  MotionFilter filter;
  WrenchFade fade;
  std::unique_ptr<GainController> controller;
  std::optional<int64_t> last_running_time_ns;
  Cadence cadence;
  FrameAnalysis latest;  // of the last frame that did not wait

  FrameAnalysis wait() const;
};

/// The paper's motion: the mean over all points.
SceneMotion mean_of_points(const TrackedFrame& tracked, int64_t interval_ns) {
  SceneMotion scene;
  scene.restarted = tracked.restarted;
  scene.tracks = &tracked.tracks;
  scene.features = tracked.features;
  if (!scene.restarted) scene.felt = mean_motion(tracked.tracks, interval_ns);
  return scene;
}

/// The result that continues while the picture is repeated.
FrameAnalysis MotionAnalyzer::Impl::wait() const {
  FrameAnalysis analysis = latest;
  analysis.restarted = false;
  analysis.same_picture = true;
  // Zero motion has nothing to continue.
  analysis.repeated = !analysis.wrench.stacked().isZero(0);
  return analysis;
}

MotionAnalyzer::MotionAnalyzer(const AnalyzerSettings& settings)
    : impl_(std::make_unique<Impl>(settings)) {}

MotionAnalyzer::~MotionAnalyzer() = default;

void MotionAnalyzer::configure(const AnalyzerSettings& settings) {
  validate(settings.tracker);
  validate(settings.controller);
  validate_rest(settings);
  impl_->tracker.configure(settings.tracker);
  const auto by_points = [](const AnalyzerSettings& s) { return s.motion == MotionKind::kMean; };
  if (by_points(settings) != by_points(impl_->settings)) {
    // What will be used next has not seen the last picture.
    impl_->tracker.restart();
    impl_->reduced.restart();
    impl_->motion.reset();
  }
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
  const bool may_wait = impl_->cadence.would_wait(running_time_ns);
  const Repeats repeats = may_wait ? Repeats::kAlike : Repeats::kSame;
  const AnalyzerSettings& settings = impl_->settings;
  const bool by_points = settings.motion == MotionKind::kMean;
  const TrackedFrame* tracked = nullptr;
  if (by_points)
    tracked = &impl_->tracker.track(frame, repeats);
  else
    impl_->reduced.read(frame, repeats);
  impl_->last_running_time_ns = running_time_ns;

  FrameAnalysis analysis;
  analysis.width = frame.width;
  analysis.height = frame.height;
  const bool comparable = by_points ? !tracked->restarted : impl_->reduced.is_comparable();
  const bool repeated = by_points ? tracked->repeated : impl_->reduced.is_repeated();
  const bool alike = by_points ? tracked->alike : impl_->reduced.is_alike();
  analysis.restarted = !comparable || !last_ns;
  if (analysis.restarted) {
    impl_->motion.reset();
  } else {
    const Cadence::Step step = impl_->cadence.see(picture_of(repeated, alike), running_time_ns);
    if (step.waits) return impl_->wait();
    analysis.interval_ns = std::max(step.interval_ns, kLeastInterval_ns);
    analysis.same_picture = repeated || alike;
  }
  const int64_t interval_ns = std::max(analysis.interval_ns, kLeastInterval_ns);
  const SceneMotion scene =
      by_points ? mean_of_points(*tracked, interval_ns)
                : impl_->motion.estimate(settings.motion, frame, impl_->reduced,
                                         impl_->field_points(), interval_ns, settings.pointer);
  analysis.features = scene.features;
  analysis.restarted = analysis.restarted || scene.restarted;
  if (analysis.restarted) {
    impl_->cadence.cut(running_time_ns);
    impl_->filter.reset();
    impl_->fade.reset();
    analysis.interval_ns = 0;
    return impl_->latest = analysis;
  }

  const double interval_s = static_cast<double>(analysis.interval_ns) * 1e-9;
  ImageMotion felt = scene.felt;
  if (repeated) {
    impl_->filter.stop();
    impl_->fade.reset();
    felt = ImageMotion();
    felt.tracked = scene.felt.tracked;
  }
  felt = faster(felt, impl_->cadence.correction(felt.velocity_px_s.norm()));
  analysis.motion = bound_motion(felt, frame.width, interval_s);
  analysis.model = scene.model;
  analysis.objects = scene.objects;
  analysis.tracks = scene.tracks;
  analysis.background = scene.background;
  analysis.object_list = scene.object_list;
  // The filter does not mix the motions of two objects.
  if (impl_->fade.turn_to(felt_object(scene, settings.motion))) impl_->filter.reset();
  const ImageMotion steady =
      impl_->filter.filter(analysis.motion, frame.height, interval_s, settings.filter);
  const Wrench wanted =
      render_motion(*impl_->controller, steady, settings.axes, frame.height, interval_s);
  analysis.wrench = impl_->fade.fade(wanted, interval_s);
  return impl_->latest = analysis;
}

std::optional<FrameAnalysis> MotionAnalyzer::repeat(int64_t running_time_ns) {
  const std::optional<int64_t> last_ns = impl_->last_running_time_ns;
  if (!last_ns || running_time_ns <= *last_ns ||
      running_time_ns - impl_->cadence.picture_ns() > Cadence::kLongest_ns) {
    restart();
    return std::nullopt;
  }
  impl_->last_running_time_ns = running_time_ns;
  if (impl_->cadence.see(Cadence::Picture::kSame, running_time_ns).waits) return impl_->wait();
  impl_->filter.stop();
  impl_->fade.reset();
  impl_->latest.motion = {};
  impl_->latest.wrench = {};
  impl_->latest.same_picture = true;
  return impl_->latest;
}

void MotionAnalyzer::restart() {
  impl_->reduced.restart();
  impl_->tracker.restart();
  impl_->motion.reset();
  impl_->controller->reset();
  impl_->cadence.restart();
  impl_->latest = {};
  impl_->last_running_time_ns.reset();
}

}  // namespace spidar
