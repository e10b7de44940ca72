// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/analysis/force_renderer.h"
#include "core/analysis/frame.h"
#include "core/motion/cadence.h"
#include "core/motion/motion_estimator.h"
#include "core/picture/area_finder.h"
#include "core/picture/image_view.h"
#include "core/picture/padded_image.h"
#include "core/picture/page_scroll.h"
#include "core/picture/reduced_frame.h"
#include "core/points/tracker.h"

namespace spidar {

/// The analysis of a frame, from picture to wrench: finds for each picture whether it repeats the
/// previous one, how the camera and the objects move (MotionEstimator), which of these is felt, and
/// with what wrench (ForceRenderer). For one thread at a time.
///
/// A frame that repeats the previous picture does not show whether anything moves. The frame waits
/// (FrameComparison::kWaiting) for up to Cadence::kRest_ns, or for as long as the film has repeated
/// pictures before; after that it counts as rest.
///
/// Where AreaFinder finds or guesses that the film is in another part of the picture than the one
/// that is measured, both parts are measured. The other part replaces the first one once it is
/// certain and its measurement is as complete, so that there is no gap.
class MotionAnalyzer {
 public:
  /// Throws std::invalid_argument when a setting is out of range, as configure() does.
  explicit MotionAnalyzer(const AnalyzerSettings& settings = {})
      : settings_(settings),
        now_(std::make_unique<Measured>(settings.tracker, next_id_)),
        next_(std::make_unique<Measured>(settings.tracker, next_id_)),
        renderer_(settings) {}

  /// Changes the settings from the next frame on. Keeps the points, and the scale of the controller
  /// unless its law changes. Throws std::invalid_argument when a setting is out of range, and then
  /// changes nothing.
  void configure(const AnalyzerSettings& settings);

  /// Frames must come in the order of display. A running time that does not increase causes a
  /// restart, because the interval would not be positive. A cut in the picture or a new size
  /// restarts points and filter only: the largest speed of eq. 13 and the scale of the adaptive
  /// controller belong to the whole video. Throws std::invalid_argument if require_usable() rejects
  /// the frame or its area. `stream_ns`, the position in the film, is for AnalyzerSettings::feel;
  /// `turn` is the turn before display. The result is valid until the next call.
  const Frame& analyze(const ImageView& image, int64_t running_ns, int64_t stream_ns = 0,
                       const Orientation& turn = {});

  /// Takes a frame that is known to repeat the previous picture, without analysing it. Returns null
  /// when the picture has been repeated for too long, or when there is no previous picture: the
  /// picture is then at rest, and the next frame is not compared with it.
  const Frame* repeat(int64_t running_ns);

  /// Call this after a flush, a seek or a discontinuity: the next frame has no motion, and the
  /// controller starts again.
  void reset();

 private:
  /// A measured part of the pictures, with the state of its analysis.
  struct Measured {
    Measured(const TrackerSettings& settings, const std::shared_ptr<uint32_t>& next_id)
        : tracker(settings), motion(next_id) {}
    void begin(const PicturePart& part) {
      area = part;
      reset();
    }
    void reset() {
      tracker.reset();
      reduced.reset();
      motion.reset();
      pairs = 0;
    }

    PicturePart area;
    ReducedFrame reduced;
    OpenCvTracker tracker;   ///< for MotionKind::kMean
    MotionEstimator motion;  ///< for all other kinds
    int pairs = 0;           ///< pairs of pictures compared since reset()
  };

  bool by_points() const { return settings_.motion == MotionKind::kMean; }
  bool finds_area() const { return settings_.area.kind == AreaSetting::Kind::kAuto; }
  void update_area(const ImageView& picture);
  void look_for_film(const ImageView& picture, const ImageView& film, int64_t running_ns);
  FrameComparison read(Measured& measured, const ImageView& film, bool may_wait = false) const;
  void set_times(const Cadence::Step& step);
  bool compare(Measured& measured, const ImageView& film, MeasuredFrame& frame,
               uint32_t felt) const;
  PicturePart film_in(const ImageView& picture) const;
  bool follow_film(const ImageView& picture, bool is_compared, int64_t running_ns);
  bool measure(const ImageView& picture, int64_t running_ns);

  AnalyzerSettings settings_;
  AreaFinder area_finder_;
  PageScroll page_scroll_;
  PaddedImage whole_;  ///< the reduced picture, if the film fills only a part of it
  /// Shared by `now_` and `next_`, so that object ids stay unique when the area changes.
  std::shared_ptr<uint32_t> next_id_ = std::make_shared<uint32_t>(1);
  std::unique_ptr<Measured> now_;
  std::unique_ptr<Measured> next_;  ///< measured in parallel; unused while its area is empty
  MeasuredFrame next_frame_;
  Cadence cadence_;
  ForceRenderer renderer_;
  std::optional<int64_t> last_running_ns_;
  bool anew_ = true;
  int64_t stream_ns_ = 0;  ///< of the newest picture
  Orientation turn_;
  Frame frame_;
};

}  // namespace spidar
