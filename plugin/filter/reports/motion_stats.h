// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "core/fields.h"
#include "plugin/frame/frame_fields.h"
#include "spidar/realtime/latency_histogram.h"

namespace spidar::filter {

/// Numbers for the `stats` property, since the stream began. Thread-safe.
class MotionStats {
 public:
  void reset() {
    const std::lock_guard<std::mutex> lock(mutex_);
    frames_ = 0;
    restarts_ = 0;
    features_ = 0;
    tracked_ = 0;
    model_.reset();
    objects_ = 0;
    film_ = {};
    analysis_.reset();
  }
  void add(const FrameReport& report) {
    const Frame& frame = report.frame;
    const std::lock_guard<std::mutex> lock(mutex_);
    ++frames_;
    if (frame.picture == FrameComparison::kFirst) ++restarts_;
    features_ = static_cast<uint32_t>(frame.features);
    tracked_ = static_cast<uint32_t>(frame.motion.tracked);
    model_.reset();
    if (frame.background) model_ = frame.background->model.kind;
    objects_ = static_cast<uint32_t>(frame.objects.size());
    film_ = report.film_part();
    analysis_.add(report.took_ns);
  }

  uint64_t frames() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return frames_;
  }

  void describe(FieldSink& to) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    to("frames", "", frames_, "frames that were analysed");
    to("restarts", "", restarts_,
       "how often the analysis began anew: at the first frame, a cut, a change of size");
    to("features", "", features_, "points that are followed from this frame on");
    to("tracked", "", tracked_, "points or blocks that the motion is measured with");
    to("model", "", model_ ? to_string(*model_) : "none",
       "model of the camera's motion: `none`, `still`, `translation`, `similarity`, `affine`, "
       "`homography`");
    to("objects", "", objects_, "objects that are known, visible or not");
    area_fields(film_, to);
    to("analysis", "ns",
       Parts{{"median", analysis_.quantile_ns(0.5)},
             {"p95", analysis_.quantile_ns(0.95)},
             {"max", analysis_.max_ns()}},
       "time of the analysis of a frame: `median`, `p95` (95 %), `max`");
  }

 private:
  mutable std::mutex mutex_;
  uint64_t frames_ = 0;
  uint64_t restarts_ = 0;
  uint32_t features_ = 0;
  uint32_t tracked_ = 0;
  std::optional<ModelKind> model_;
  uint32_t objects_ = 0;
  PicturePart film_;
  /// 10 µs to 50 ms: a longer analysis is too slow for any video.
  DurationHistogram<5000, 10'000> analysis_;
};

}  // namespace spidar::filter
