// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numbers of an element, for its `stats` property.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include <gst/gst.h>

#include "plugin/frame/frame_report.h"
#include "plugin/frame/motion_message.h"
#include "spidar/realtime/latency_histogram.h"

namespace spidar::filter {

/// Numbers since the stream began. Thread-safe.
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
    if (frame.picture == Likeness::kFirst) ++restarts_;
    features_ = frame.features;
    tracked_ = frame.motion.tracked;
    model_.reset();
    if (frame.background) model_ = frame.background->model.kind;
    objects_ = static_cast<int>(frame.objects.size());
    film_ = report.film_part();
    analysis_.add(report.took_ns);
  }

  uint64_t frames() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return frames_;
  }

  /// Adds the fields that docs/fields.toml describes, of what is felt or of the last frame.
  void describe(GstStructure* structure) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    set_area(structure, film_);
    gst_structure_set(
        structure, "frames", G_TYPE_UINT64, frames_, "restarts", G_TYPE_UINT64, restarts_,
        "features", G_TYPE_UINT, static_cast<guint>(features_), "tracked", G_TYPE_UINT,
        static_cast<guint>(tracked_), "model", G_TYPE_STRING, model_ ? to_string(*model_) : "none",
        "objects", G_TYPE_UINT, static_cast<guint>(objects_), "analysis-median", G_TYPE_UINT64,
        static_cast<guint64>(analysis_.quantile_ns(0.5)), "analysis-p95", G_TYPE_UINT64,
        static_cast<guint64>(analysis_.quantile_ns(0.95)), "analysis-max", G_TYPE_UINT64,
        static_cast<guint64>(analysis_.max_ns()), nullptr);
  }

 private:
  mutable std::mutex mutex_;
  uint64_t frames_ = 0;
  uint64_t restarts_ = 0;
  int features_ = 0;
  int tracked_ = 0;
  std::optional<ModelKind> model_;
  int objects_ = 0;
  PicturePart film_;
  /// 10 µs to 50 ms: more than that is too slow for any video.
  DurationHistogram<5000, 10'000> analysis_;
};

}  // namespace spidar::filter
