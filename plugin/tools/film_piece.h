// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Decodes only a piece of a film.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include <gst/gst.h>

#include "core/analysis/piece_end.h"
#include "plugin/tools/record_properties.h"
#include "plugin/tools/second_run.h"

namespace spidar {

/// Makes a pipeline measure the frames of a piece, and end where PieceEnd says. Outlives the
/// pipeline.
class FilmPiece {
 public:
  explicit FilmPiece(const MotionPiece& piece) : piece_(piece) {}
  FilmPiece(const FilmPiece&) = delete;
  FilmPiece& operator=(const FilmPiece&) = delete;

  /// Its length. Throws std::runtime_error when that is not known (0).
  void set_film(int64_t film_ns);
  /// `pipeline` has a spidarmotion "motion" that attaches meta.
  void begin(GstElement* pipeline, const RecordProperties& properties);

  /// When the pipeline has ended without an error.
  MotionPiece found() const;
  /// Whether the piece before has to go on instead.
  bool is_empty() const;

 private:
  enum class Stage { kBegin, kSeeking, kSought, kThere };

  static GstPadProbeReturn comes(GstPad* pad, GstPadProbeInfo* info, gpointer self);
  static GstPadProbeReturn passes(GstPad* pad, GstPadProbeInfo* info, gpointer self);
  static void seek(GstElement* motion, gpointer self);
  bool is_wanted(std::optional<int64_t> stream_ns);
  void await_seek(GstPad* pad);
  bool is_last(GstPad* pad, GstBuffer* frame);

  MotionPiece piece_;
  std::optional<PieceEnd> end_;
  std::optional<SecondRun> second_;  ///< of the next piece
  RunMessages messages_;             ///< of this one
  mutable std::mutex lock_;
  std::condition_variable changed_;
  Stage stage_ = Stage::kBegin;
  int64_t target_ns_ = 0;  ///< of the seek
  int64_t earlier_ns_ = 5'000'000'000;
  bool has_ended_ = false;
};

}  // namespace spidar
