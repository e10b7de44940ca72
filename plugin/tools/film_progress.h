// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Follows a film through a pipeline with spidarmotion that reads it as fast as it can.
#pragma once

#include <functional>

#include <gst/gst.h>

#include "plugin/tools/record_options.h"

namespace spidar::tools {

/// So long nothing may come from a slow network share.
constexpr GstClockTime kSlowShare = 60 * GST_SECOND;

constexpr const char* kEndMissing = "its end is missing: it is damaged or cut off";

/// Sets the properties on a spidarmotion.
void set_properties(GstElement* motion, const RecordProperties& properties);

/// Reports how many percent of a film are done. Outlives the pipeline.
class FilmProgress {
 public:
  /// `tell` is called in a streaming thread whenever the number has risen.
  explicit FilmProgress(std::function<void(int percent)> tell);

  /// Counts the frames that come out of `motion`.
  void watch(GstElement* motion);

 private:
  static GstPadProbeReturn passes(GstPad* frames, GstPadProbeInfo* info, gpointer self);

  const std::function<void(int percent)> tell_;
  gint64 film_ns_ = 0;
  int told_ = 0;
};

}  // namespace spidar::tools
