// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/force_renderer.h"

#include <stdexcept>

namespace spidar {
namespace {

/// The id of the felt object; 0 if no single object is felt. A visible object at rest also counts.
uint32_t felt_object(const Frame& frame, MotionKind kind, const Chosen& choice) {
  const MovingObject* object = choice.object;
  if (choice.is_free() && kind == MotionKind::kObject) object = frame.dominant_object();
  if (!object) return 0;
  const bool is_lost = object->points == 0 && object->relative_px_s.isZero(0);
  return is_lost ? 0 : object->id;
}

/// Returns the number by which WrenchFade recognizes what is felt. It differs between rules, even
/// for the same object, because their gains may differ.
uint64_t fade_key(const Chosen& choice, uint32_t object) {
  constexpr uint32_t kPicture = UINT32_MAX;
  uint64_t target = object;
  if (!choice.is_kept && choice.rule) {
    const bool is_picture = choice.rule->kind == FeelRule::Kind::kCamera ||
                            choice.rule->kind == FeelRule::Kind::kRegion;
    if (is_picture) target = kPicture;
    if (target != 0) target |= static_cast<uint64_t>(choice.rule->line) << 32;
  }
  return target;
}

/// Applies the gain of a rule. A gain above 1 raises the force to at most `most_N`.
Wrench amplified(const Wrench& wrench, double gain, double most_N) {
  const double force_N = size_N(wrench);
  if (gain == 1 || force_N == 0) return wrench;
  const double factor = std::min(gain, std::max(most_N / force_N, std::min(gain, 1.0)));
  return {factor * wrench.force_N, factor * wrench.torque_Nm};
}

/// Returns `motion` with all rates multiplied by `factor`.
ImageMotion faster(ImageMotion motion, double factor) {
  motion.velocity_px_s *= factor;
  motion.growth_1_s *= factor;
  motion.roll_rad_s *= factor;
  motion.dead_zone_px_s *= factor;
  return motion;
}

ChoiceInput choice_frame(const Frame& frame, const AnalyzerSettings& settings, int64_t stream_ns,
                         const Orientation& turn) {
  return {frame.objects,
          frame.background ? &*frame.background : nullptr,
          frame.place,
          frame.interval_s(),
          frame.picture == FrameComparison::kFirst,
          stream_ns,
          turn,
          settings.boxes.get()};
}

ImageMotion free_motion(const Frame& frame, const AnalyzerSettings& settings) {
  switch (settings.motion) {
    case MotionKind::kMean:
      return frame.mean;
    case MotionKind::kCamera:
      if (!frame.background) return {};
      return camera_motion(*frame.background, frame.votes, frame.interval_s());
    case MotionKind::kObjects:
      return motion_at_pointer(frame.objects, frame.place.film_px(settings.pointer),
                               frame.shown_height_px);
    case MotionKind::kObject:
      break;
  }
  const MovingObject* const object = frame.dominant_object();
  return object ? relative_motion(*object) : ImageMotion();
}

ImageMotion motion_of_choice(const Frame& frame, const AnalyzerSettings& settings,
                             const ChoiceInput& input, const Chosen& choice) {
  if (choice.is_free()) return free_motion(frame, settings);
  if (choice.object) return relative_motion(*choice.object);
  if (choice.is_kept || !frame.background) return {};
  if (choice.rule->kind == FeelRule::Kind::kRegion) {
    const FeelRule& region = *choice.rule;
    return motion_in_box(frame.objects, input.px(region.position, region.far_corner));
  }
  if (choice.rule->kind == FeelRule::Kind::kCamera) {
    return camera_motion(*frame.background, frame.votes, frame.interval_s());
  }
  return {};
}

}  // namespace

AnalyzerSettings paper_settings() {
  AnalyzerSettings settings;
  settings.motion = MotionKind::kMean;
  settings.filter.min_cutoff_Hz = 0;
  settings.controller.law = ControlLaw::kNonlinear;
  return settings;
}

void validate(const AnalyzerSettings& settings) {
  validate(settings.tracker);
  validate(settings.controller);
  validate(settings.filter);
  validate(settings.axes);
  validate_washout(settings.washout_Hz);
  if (!settings.pointer.allFinite()) {
    throw std::invalid_argument("the pointer's coordinates must be finite");
  }
  if (!settings.kept.position.allFinite()) {
    throw std::invalid_argument("the coordinates of a click must be finite");
  }
}

ForceRenderer::ForceRenderer(const AnalyzerSettings& settings) : controller_(settings.controller) {
  validate(settings);
  choice_.set_rules(settings.feel);
  choice_.set_kept(settings.kept);
}

void ForceRenderer::configure(const AnalyzerSettings& settings) {
  validate(settings);
  controller_.configure(settings.controller);
  choice_.set_rules(settings.feel);
  choice_.set_kept(settings.kept);
}

void ForceRenderer::reset() {
  controller_.reset();
  choice_.reset();
}

void ForceRenderer::render(Frame& frame, const AnalyzerSettings& settings, int64_t stream_ns,
                           const Orientation& turn) {
  frame.shown_height_px = turn.is_sideways() ? frame.width() : frame.height();
  const ChoiceInput input = choice_frame(frame, settings, stream_ns, turn);
  Chosen choice;
  if (settings.motion != MotionKind::kMean && frame.width() != 0) choice = choice_.choose(input);
  frame.choice = choice;
  frame.choice.object = nullptr;
  if (frame.picture == FrameComparison::kFirst) {
    lost_frames_.reset();
    filter_.reset();
    washout_.reset();
    fade_.reset();
    frame.felt_object = 0;
    frame.motion = {};
    frame.wrench = {};
    return;
  }
  frame.felt_object = felt_object(frame, settings.motion, choice);
  ImageMotion felt = motion_of_choice(frame, settings, input, choice);
  if (frame.picture == FrameComparison::kSame) {
    filter_.stop();
    washout_.reset();
    fade_.reset();
    const int tracked = felt.tracked;
    felt = ImageMotion();
    felt.tracked = tracked;
  }
  felt = faster(felt, lost_frames_.correction(frame.interval_ns, frame.shown_for_ns,
                                              felt.velocity_px_s.norm()));
  const double interval_s = frame.interval_s();
  frame.motion = bound_motion(felt, frame.width(), interval_s);
  // Neither filter nor washout may mix the motions of two objects.
  if (fade_.set_object(fade_key(choice, frame.felt_object))) {
    filter_.reset();
    washout_.reset();
  }
  const ImageMotion steady =
      filter_.filter(frame.motion, frame.shown_height_px, interval_s, settings.filter);
  const Wrench wanted =
      render_motion(controller_, steady, settings.axes, frame.shown_height_px, interval_s);
  const double gain = choice.rule && !choice.is_kept ? choice.rule->gain : 1;
  const double most_N = settings.controller.max_force_N;
  const Wrench passed =
      washout_.apply(amplified(wanted, gain, most_N), interval_s, settings.washout_Hz, most_N);
  frame.wrench = fade_.fade(passed, interval_s);
}

}  // namespace spidar
