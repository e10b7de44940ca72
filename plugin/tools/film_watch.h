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

/// The longest time in which nothing may come from a slow network share.
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

/// Follows a film through a pipeline that reads as fast as it can: chooses the video, and notices
/// damage. GStreamer ends a truncated film like a whole one, and leaves it to the application to
/// judge its warnings. Outlives the pipeline.
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
  /// than two frames is wrong, too.
  std::string why_ended(const std::string& error) const;
  /// A remark on the track of a film that is whole; usually empty.
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
  bool failed_ = false;        ///< with an error, from which later warnings follow
  std::string warning_;        ///< the first one
  std::string remark_;         ///< the first warning of spidarmotion
  bool has_appended_ = false;  ///< demuxers warn that they cannot parse data behind the film
  bool unmeasured_ = false;    ///< several frames in a row; the remark says why
  std::string missing_;        ///< the missing decoder of the video
  bool has_video_ = true;      ///< unknown until chosen
  std::string why_no_video_;
  uint64_t frames_ = 0;
  std::array<int, kNoForceReasons> frames_by_reason_{};  ///< of measured frames
};

}  // namespace spidar::tools
