// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

#include <gst/gst.h>

#include "plugin/films/video_choice.h"
#include "plugin/reasons/no_force.h"
#include "plugin/tools/record_options.h"

namespace spidar {
class FilePipeline;
}  // namespace spidar

namespace spidar::tools {

/// The timeout without data that allows for a slow network share.
constexpr GstClockTime kShareTimeout = 60 * GST_SECOND;

constexpr const char* kEndMissing = "its end is missing: it is damaged or cut off";

/// Sets the properties of a spidarmotion element.
void set_properties(GstElement* motion, const RecordProperties& properties);

/// Reports the progress of a film in percent. Must outlive the pipeline.
class FilmProgress {
 public:
  /// `report` is called in a streaming thread whenever the percentage has risen.
  explicit FilmProgress(std::function<void(int percent)> report);

  /// Follows the timestamps of the frames that leave `motion`.
  void watch(GstElement* motion);

 private:
  static GstPadProbeReturn on_frame(GstPad* frames, GstPadProbeInfo* info, gpointer self);

  const std::function<void(int percent)> report_;
  gint64 film_ns_ = 0;
  int reported_ = 0;
};

/// Monitors a pipeline that reads a film as fast as possible: selects the video stream and detects
/// damage. GStreamer ends a truncated film like a complete one and leaves the judgement of warnings
/// to the application. Must outlive the pipeline.
class FilmWatch {
 public:
  FilmWatch() = default;
  FilmWatch(const FilmWatch&) = delete;
  FilmWatch& operator=(const FilmWatch&) = delete;

  /// `pipeline` reads `film`, and has a decodebin "decode" with its video linked to "convert".
  void begin(GstElement* pipeline, const std::string& film);

  /// Plays the film to its end. Throws std::runtime_error with what is wrong with the film.
  void play(const FilePipeline& file) const;
  /// After the pipeline has ended, with `error` or, if that is empty, at the end of the film:
  /// returns a sentence that says what is wrong with the film, or an empty string. A film of fewer
  /// than two frames is an error, too.
  std::string why_ended(const std::string& error) const;
  /// A remark on the track of an undamaged film; usually empty.
  const std::string& remark() const { return remark_; }
  /// Sentences: what fraction of the frames is felt, and the commonest reason for the others.
  std::string felt() const;

 private:
  static GstBusSyncReply handle(GstBus* bus, GstMessage* message, gpointer self);
  static GstPadProbeReturn decoded(GstPad* pad, GstPadProbeInfo* info, gpointer self);
  static void choose(GstElement* decoder, gpointer self);

  VideoChoice videos_{VideoChoice::Rule::kFirst};
  GstElement* convert_ = nullptr;
  mutable std::mutex lock_;
  bool failed_ = false;        ///< there was an error; later warnings are its consequences
  std::string warning_;        ///< the first one
  std::string remark_;         ///< the first warning of spidarmotion
  bool has_appended_ = false;  ///< data follows the film; demuxers warn that they cannot parse it
  bool unmeasured_ = false;    ///< several frames in a row were not measured; see remark_
  std::string missing_;        ///< the missing decoder of the video
  bool has_video_ = true;      ///< unknown until chosen
  std::string why_no_video_;
  uint64_t frames_ = 0;
  std::array<int, kNoForceReasons> frames_by_reason_{};  ///< of measured frames
};

}  // namespace spidar::tools
