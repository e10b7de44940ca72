// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "core/track/exchange_formats.h"
#include "core/track/track_format.h"
#include "plugin/tracks/script_set.h"
#include "plugin/tracks/track_input.h"
#include "plugin/tracks/track_tags.h"
#include "spidar/part_file.h"

namespace spidar::tools {

/// A file of F32 samples beside the target that is made of them; the object removes it.
class SampleFile {
 public:
  /// `target` is the file that is made. Throws std::runtime_error as PartFile does.
  explicit SampleFile(const std::string& target) : part_(target + ".raw", {true, {}}) {}

  /// Throws std::runtime_error when the sample cannot be written.
  void add(const TrackSample& sample);
  /// Writes all added samples to the file.
  void flush();

  size_t count() const { return count_; }
  const std::string& path() const { return part_.path(); }
  /// All samples, times `gain`. Throws std::runtime_error on a read error. Call flush() before.
  SampleSource samples(double gain = 1) const;

 private:
  PartFile part_;
  std::vector<TrackSample> waiting_;
  size_t count_ = 0;
};

struct TrackCondition {
  std::string track;     ///< the file that has the samples
  std::string film;      ///< the named film, if the name is not that of a track; empty: none
  std::string other;     ///< why the track belongs to another film; empty if not
  int64_t later_ns = 0;  ///< how much later than the track says the film shows its pictures
  tracks::Faults faults;
  std::string missing;  ///< what is missing at the end of the file; empty if nothing
  tracks::Notes notes;
  std::vector<std::string> about;  ///< lines on the axes of funscripts
};

/// The upward force: the channel of formats that have only one.
constexpr size_t kUsualAxis = 1;

/// Whether `path` is a track, or a film with one inside it, beside it or in a folder of tracks.
/// Throws std::runtime_error for a single picture.
bool has_track(const std::string& path);

/// Passes `take` the samples of a track, or of a film with a track (has_track()), in order; for a
/// film, the track is the file `track` unless that is empty. The format follows from the end of the
/// name: HJIF (`.hjif`), one channel (`.funscript`), else sound of any rate that spidarsink
/// accepts, which keeps its rate. Gaps become silence, and so do samples that are not numbers,
/// which are counted. Throws std::runtime_error.
TrackCondition read_track(const std::string& path, const SampleSource::Take& take,
                          const tracks::ScriptChoice& script = {}, const std::string& track = {});

/// Throws std::runtime_error when the track belongs to another film than the named one.
void expect_own_track(const TrackCondition& condition);

struct SaveOptions {
  /// For HJIF, AHAP and funscript, as a fraction of the full scale; nothing: the default of each.
  std::optional<double> tolerance;
  size_t axis = kUsualAxis;  ///< of a funscript
  double gain = 1;           ///< for AHAP and funscript
  tracks::Notes notes;       ///< for sound
};

/// Throws std::runtime_error when files with the extension of `path` cannot be written.
void check_format(const std::string& path);

/// Fills `part`, whose format follows from the end of the name that it will have: `.flac`, `.wav`,
/// `.mka` (both F32), `.hjif`, `.ahap` or `.funscript`. Throws std::runtime_error.
void save_track(PartFile& part, const SampleFile& samples, const SaveOptions& options = {});

/// The elements with which GStreamer makes such a file from samples: "flacenc blocksize=40", …;
/// empty when it cannot.
std::string encoder_of(const std::string& path);

/// Whether `text` ends with `end`, ignoring case.
bool ends_with(const std::string& text, const std::string& end);

/// The checksum of sound that flows through a pad. Outlives the pipeline.
class StoredSound {
 public:
  StoredSound() = default;
  StoredSound(const StoredSound&) = delete;
  StoredSound& operator=(const StoredSound&) = delete;

  /// Adds what flows into `element`, whose pipeline has not started.
  void watch(GstElement* element);
  /// Decodes the file `part`, which a pipeline with an element "stored" (encoder_of()) has written.
  /// Throws std::runtime_error when the file differs from what has flowed.
  void check(const PartFile& part) const;

 private:
  static GstPadProbeReturn flows(GstPad* pad, GstPadProbeInfo* info, gpointer self);

  std::string format_;  ///< of the samples, as caps name it
  uint64_t bytes_ = 0;
  std::unique_ptr<GChecksum, void (*)(GChecksum*)> sum_{g_checksum_new(G_CHECKSUM_SHA1),
                                                        g_checksum_free};
};

}  // namespace spidar::tools
