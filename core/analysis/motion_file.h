// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// All that was measured of a film, as one file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/analysis/measured_frame.h"
#include "core/analysis/motion_rows.h"
#include "core/motion/scene_motion.h"
#include "core/picture_turn.h"

namespace spidar {

/// A file that cannot be read; the message is the rest of a sentence about it.
struct MotionFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Which part of a film was measured, for a MotionJoin.
struct MotionPiece {
  int number = 0;  ///< from 1
  int of = 0;      ///< pieces; 0: all of the film was measured at once
  int64_t film_ns = 0;
  bool has_end = false;  ///< it goes on to the end of the film
  std::string program;   ///< version that measured it
  std::string format;    ///< of the track that is to be made of all pieces; empty: none
};

/// What the file says of itself. The file is a sequence of CBOR maps (RFC 8742): this, then
/// kChunkFrames frames at a time as columns (pack_columns()), then the number of all frames.
struct MotionHeader {
  static constexpr int kVersion = 1;

  std::string film;      ///< FilmFingerprint as text; empty: not known
  std::string settings;  ///< of the measurement, those that are not defaults: "quality=fine"
  bool is_mean = false;  ///< measured for motion=mean, which needs and gives other things
  MotionPiece piece = {};
};

/// Empty, or why this motion cannot be felt from such a file, as the rest of a sentence. A piece of
/// an analysis cannot be felt at all.
std::string wrong_motion(const MotionHeader& header, MotionKind motion);

std::string write_header(const MotionHeader& header);
/// Reads it from the beginning of a file. Throws MotionFileError.
MotionHeader read_header(std::istream& file);

/// What happens at one moment of a film.
struct MotionMoment {
  MomentKind kind = MomentKind::kFrame;
  int64_t stream_ns = 0;
  int64_t duration_ns = -1;  ///< -1: not known
  bool empty = false;        ///< a buffer without picture
  PictureTurn turn;          ///< of the picture before it is shown
};

/// Frames in, bytes out.
class MotionFileWriter {
 public:
  /// About a minute; what a program that is killed loses.
  static constexpr size_t kChunkFrames = 2048;

  /// `frame` counts only with MomentKind::kFrame. Appends to `bytes` what is ready to be written.
  void add(const MotionMoment& moment, const MeasuredFrame& frame, std::string& bytes);
  /// The same from a file.
  void add(const FrameRow& row, const std::vector<ObjectCode>& objects, std::string& bytes);
  /// Appends the rest.
  void finish(std::string& bytes);

 private:
  void write_chunk(std::string& bytes);

  MotionRows rows_;
  size_t written_ = 0;
};

/// A whole file in memory, about 20 MB for an hour.
class MotionFile {
 public:
  /// Throws MotionFileError when it is none, of another version, cut off or damaged.
  explicit MotionFile(std::istream& file);

  const MotionHeader& header() const { return header_; }
  size_t size() const { return rows_.frames.size(); }
  MotionMoment moment(size_t i) const;
  const FrameRow& row(size_t i) const { return rows_.frames[i]; }
  std::vector<ObjectCode> objects(size_t i) const;
  /// The frame of moment `i`, which is a MomentKind::kFrame. If it waits, `frame` keeps what it has
  /// of the frame before.
  void load(size_t i, MeasuredFrame& frame) const;

 private:
  void add_chunk(MotionRows chunk);

  MotionHeader header_;
  MotionRows rows_;
  std::vector<size_t> first_object_;  ///< of each frame, and the end
};

}  // namespace spidar
