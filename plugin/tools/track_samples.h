// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Whole tracks of 1000 samples a second, from and to files of every kind.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "core/track/track_format.h"
#include "plugin/track/track_input.h"

namespace spidar {

/// What a file says that is not in its samples.
struct TrackCondition {
  TrackFaults faults;
  std::string missing;  ///< empty, or what is missing at the end of the file
};

/// By the end of its name: HJIF (`.hjif`), the trace of spidarmotion (`.csv`, `.jsonl`), else
/// sound, of any rate that spidarsink takes; gaps are silence, and so are samples that are not
/// numbers, which `condition` counts. Throws std::runtime_error.
std::vector<TrackSample> load_track(const std::string& path, TrackCondition* condition = nullptr);

struct SaveOptions {
  double hjif_tolerance = 4e-4;  ///< of the full scale
  size_t funscript_axis = 0;     ///< channel
};

/// By the end of its name: `.flac`, `.wav`, `.mka` (both F32), `.hjif` or `.funscript`. A file that
/// is there is replaced when the new one is complete. Throws std::runtime_error.
void save_track(const std::string& path, const std::vector<TrackSample>& samples,
                const SaveOptions& options = {});

/// What GStreamer makes such a file of samples with: "flacenc blocksize=40", …; empty when it
/// cannot.
std::string encoder_of(const std::string& path);

/// Runs a pipeline to its end. `prepare` gets it before it starts. Throws std::runtime_error with
/// what it said.
void run_pipeline(const std::string& line,
                  const std::function<void(GstElement* pipeline)>& prepare = {});

/// Returns when `awaited` was posted. Throws std::runtime_error with what went wrong: an error that
/// was posted, a change of state that failed, or nothing for as long as `limit`: decodebin keeps an
/// error of a demuxer to itself when it comes at the wrong moment.
void await_message(GstElement* pipeline, GstMessageType awaited,
                   GstClockTime limit = GST_CLOCK_TIME_NONE);

bool ends_with(const std::string& text, const std::string& end);
/// For a location in a launch line.
std::string quoted(const std::string& path);

}  // namespace spidar
