// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads and writes whole tracks of 1000 samples a second, in all file formats.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "core/track/track_format.h"
#include "plugin/tracks/part_file.h"
#include "plugin/tracks/track_input.h"
#include "plugin/tracks/track_notes.h"

namespace spidar {

/// What is known of a track besides its samples.
struct TrackCondition {
  std::string track;  ///< the file that has the samples
  std::string film;   ///< the film that was given in its place; empty: none
  std::string other;  ///< why the track is that of another film; empty when it is not
  TrackFaults faults;
  std::string missing;  ///< what is missing at the end of the file; empty if it is complete
  TrackNotes notes;
};

/// The force upwards: the channel of formats that have only one.
constexpr size_t kUsualAxis = 1;

/// Of a track, or of a film with a track inside it or beside it. The format follows from the end of
/// the name: HJIF (`.hjif`), one channel (`.funscript`), else sound of any rate that spidarsink
/// accepts. Gaps become silence, and so do samples that are not numbers, which `condition` counts.
/// Throws std::runtime_error.
std::vector<TrackSample> load_track(const std::string& path, TrackCondition* condition = nullptr,
                                    size_t funscript_axis = kUsualAxis);

/// Throws std::runtime_error when the track is that of another film than the one that was given.
void expect_own_track(const TrackCondition& condition);

struct SaveOptions {
  std::optional<double>
      tolerance;  ///< of HJIF, AHAP and funscript, of the full scale; of each its own default
  size_t axis = kUsualAxis;  ///< the channel of a funscript, and of sound with a rate
  int rate_Hz = 0;           ///< of sound with one channel; 0: all six, 1000 samples a second
  double gain = 1;           ///< that the samples have been multiplied by
  TrackNotes notes;          ///< for sound
};

/// The format follows from the end of the name: `.flac`, `.wav`, `.mka` (both F32), `.hjif`,
/// `.ahap` or `.funscript`. An existing file is replaced when the new one is complete. Throws
/// std::runtime_error.
void save_track(const std::string& path, const std::vector<TrackSample>& samples,
                const SaveOptions& options = {});

/// The elements with which GStreamer makes such a file from samples: "flacenc blocksize=40", …;
/// empty when it cannot.
std::string encoder_of(const std::string& path);

/// Much longer than a pipeline needs for its first buffers, also on a slow share.
constexpr GstClockTime kLongestStart = 60 * GST_SECOND;

/// A pipeline failed without an error message.
class SilentFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs a pipeline to its end. `prepare` is called with it before it starts. Throws as
/// await_message().
void run_pipeline(const std::string& line,
                  const std::function<void(GstElement* pipeline)>& prepare = {},
                  GstClockTime start_limit = kLongestStart);

/// Returns when `awaited` was posted. Throws std::runtime_error with an error that was posted, and
/// SilentFailure after a change of state that failed or took longer than `start_limit`, or nothing
/// for as long as `limit`. decodebin keeps an error of a demuxer to itself when it comes at the
/// wrong moment, and then waits for ever.
void await_message(GstElement* pipeline, GstMessageType awaited,
                   GstClockTime limit = GST_CLOCK_TIME_NONE,
                   GstClockTime start_limit = kLongestStart);

/// Of the source or sink `name` in a pipeline. Unlike a launch line, it takes every file name.
void set_location(GstElement* pipeline, const char* name, const std::string& path);

/// In small or capital letters.
bool ends_with(const std::string& text, const std::string& end);

/// Sound that flows through a pad, as a checksum. Outlives the pipeline.
class StoredSound {
 public:
  StoredSound() = default;
  StoredSound(const StoredSound&) = delete;
  StoredSound& operator=(const StoredSound&) = delete;

  /// Of the element `name` in a pipeline that has not started.
  void watch(GstElement* pipeline, const char* name);
  /// Decodes the file `part`, which a pipeline with an element "stored" (encoder_of()) has written.
  /// Throws std::runtime_error when that is not what has flowed.
  void check(const PartFile& part) const;

 private:
  static GstPadProbeReturn flows(GstPad* pad, GstPadProbeInfo* info, gpointer self);

  std::string format_;  // of the samples, as caps name it
  uint64_t bytes_ = 0;
  uint64_t sum_ = 0xcbf29ce484222325;  // FNV-1a
};

}  // namespace spidar
