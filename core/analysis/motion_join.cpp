// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_join.h"

#include <algorithm>
#include <cstdio>

#include "core/analysis/common_past.h"
#include "core/analysis/motion_columns.h"

namespace spidar {
namespace {

std::string seconds(int64_t ns) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f s", 1e-9 * static_cast<double>(ns));
  return text;
}

std::string name_of(const MotionPiece& piece) {
  return "piece " + std::to_string(piece.number) + " of " + std::to_string(piece.of);
}

std::string shown(const std::string& settings) {
  return settings.empty() ? "the defaults" : settings;
}

bool is_frame(const FrameRow& row) {
  return row.moment == static_cast<uint8_t>(MomentKind::kFrame);
}

bool is_cut(const FrameRow& row) {
  return is_frame(row) && row.shown == static_cast<uint8_t>(Shown::kFirst);
}

/// The largest id in the rows before the one of this index. Ids count on, so that later objects
/// have larger ones.
template <typename Objects>
uint32_t largest_id(size_t end, Objects&& objects_of) {
  uint32_t largest = 0;
  for (size_t i = 0; i < end; ++i) {
    for (const ObjectCode& object : objects_of(i)) largest = std::max(largest, object.id);
  }
  return largest;
}

/// Ids from which `before` is subtracted and to which `after` is added; 0 stays 0.
uint32_t renumbered(uint32_t id, uint32_t before, uint32_t after) {
  return id == 0 ? 0 : id - before + after;
}

void add_row(FrameRow row, std::vector<ObjectCode> objects, uint32_t ids, MotionRows& rows) {
  row.dominant = renumbered(row.dominant, ids, 0);
  for (ObjectCode& object : objects) {
    object.id = renumbered(object.id, ids, 0);
    rows.objects.push_back({static_cast<uint32_t>(rows.frames.size()), object});
  }
  rows.frames.push_back(row);
}

}  // namespace

/// Throws MotionFileError when the next piece is of another analysis.
void MotionJoin::check(const MotionHeader& next) const {
  const MotionPiece& piece = next.piece;
  if (piece.of == 0) {
    throw MotionFileError("it is the analysis of a whole film, and there is nothing to join");
  }
  if (piece.number != pieces_ + 1) {
    throw MotionFileError("it is " + name_of(piece) + ", and piece " + std::to_string(pieces_ + 1) +
                          " is missing");
  }
  if (pieces_ == 0) return;
  const MotionPiece& other = header_.piece;
  if (piece.of != other.of) {
    throw MotionFileError("it is " + name_of(piece) + ", and the one before is " + name_of(other));
  }
  if (next.film != header_.film) throw MotionFileError("it is of another film than piece 1");
  if (piece.film_ns != other.film_ns) {
    throw MotionFileError("the film was " + seconds(piece.film_ns) +
                          " long, and for piece 1 it was " + seconds(other.film_ns) +
                          ": measure all pieces of the film as it is now");
  }
  if (next.settings != header_.settings || piece.format != other.format) {
    throw MotionFileError("it was measured with " + shown(next.settings) +
                          (piece.format.empty() ? "" : " for " + piece.format) +
                          ", and piece 1 with " + shown(header_.settings) +
                          (other.format.empty() ? "" : " for " + other.format));
  }
  if (piece.program != other.program) {
    throw MotionFileError("it was measured by version " + piece.program +
                          ", and piece 1 by version " + other.program);
  }
}

void MotionJoin::add(const MotionFile& piece) {
  check(piece.header());
  if (pieces_ == 0 && piece.size() == 0) throw MotionFileError("there are no frames in it");
  if (pieces_++ == 0) {
    header_ = piece.header();
    return append(piece, {});
  }
  // What is before it may run on to the end of the film, or of this piece.
  const bool goes_on = piece.size() > 0 && !header_.piece.has_end &&
                       (piece.header().piece.has_end ||
                        piece.row(piece.size() - 1).stream_ns > frames_.back().stream_ns);
  if (!goes_on) return;
  if (const std::optional<Place> place = find_join(piece)) return append(piece, *place);
  // The one before may continue until a later one.
  if (problem_.empty()) problem_ = why_not_joined(piece);
}

std::string MotionJoin::why_not_joined(const MotionFile& piece) const {
  const std::string name = name_of(piece.header().piece);
  const int64_t begin_ns = piece.row(0).stream_ns;
  if (begin_ns > frames_.back().stream_ns) {
    return name + " begins at " + seconds(begin_ns) + ", and what is before it ends at " +
           seconds(frames_.back().stream_ns);
  }
  return "from " + seconds(differs_ns_.value_or(begin_ns)) + " on, " + name +
         " differs from the one before, and no cut makes them equal: measure the film in one piece";
}

std::optional<MotionJoin::Place> MotionJoin::find_join(const MotionFile& piece) {
  CommonPast past;
  Place at;
  while (at.here < frames_.size() && at.there < piece.size()) {
    const FrameRow& here = frames_[at.here];
    const FrameRow& there = piece.row(at.there);
    if (here.stream_ns != there.stream_ns) {
      past.restart();
      ++(here.stream_ns < there.stream_ns ? at.here : at.there);
      continue;
    }
    if (here.moment != there.moment || here.shown != there.shown || here.anew != there.anew ||
        here.empty != there.empty) {
      past.restart();
    } else {
      const bool joins = is_cut(here) && (here.anew != 0 || past.is_enough());
      if (joins && is_same_from(at, piece)) return at;
      if (joins && !differs_ns_) differs_ns_ = here.stream_ns;
      if (is_frame(here)) {
        past.add(static_cast<Shown>(here.shown), here.stream_ns, here.empty == 0);
      } else if (here.moment == static_cast<uint8_t>(MomentKind::kUnknown)) {
        past.restart();
      }
    }
    ++at.here;
    ++at.there;
  }
  return {};
}

/// Whether both have the same rows until one of them ends.
bool MotionJoin::is_same_from(const Place& place, const MotionFile& piece) const {
  const uint32_t ids_here = largest_id(place.here, [&](size_t i) { return objects_[i]; });
  const uint32_t ids_there = largest_id(place.there, [&](size_t i) { return piece.objects(i); });
  const size_t rows = std::min(frames_.size() - place.here, piece.size() - place.there);
  MotionRows here, there;
  for (size_t i = 0; i < rows; ++i) {
    add_row(frames_[place.here + i], objects_[place.here + i], ids_here, here);
    add_row(piece.row(place.there + i), piece.objects(place.there + i), ids_there, there);
  }
  return pack_columns(here) == pack_columns(there);
}

void MotionJoin::append(const MotionFile& piece, const Place& from) {
  const uint32_t before = largest_id(from.there, [&](size_t i) { return piece.objects(i); });
  const uint32_t after = largest_id(from.here, [&](size_t i) { return objects_[i]; });
  frames_.resize(from.here);
  objects_.resize(from.here);
  for (size_t i = from.there; i < piece.size(); ++i) {
    frames_.push_back(piece.row(i));
    frames_.back().dominant = renumbered(frames_.back().dominant, before, after);
    objects_.push_back(piece.objects(i));
    for (ObjectCode& object : objects_.back()) object.id = renumbered(object.id, before, after);
  }
  header_.piece.has_end = piece.header().piece.has_end;
}

std::string MotionJoin::whole() const {
  const MotionPiece& piece = header_.piece;
  if (pieces_ < piece.of) {
    throw MotionFileError("piece " + std::to_string(pieces_ + 1) + " of " +
                          std::to_string(piece.of) + " is missing");
  }
  if (!piece.has_end) {
    throw MotionFileError(problem_.empty() ? "the end of the film is in none of the pieces"
                                           : problem_);
  }
  MotionHeader header = header_;
  header.piece = {};
  std::string bytes = write_header(header);
  MotionFileWriter writer;
  for (size_t i = 0; i < frames_.size(); ++i) writer.add(frames_[i], objects_[i], bytes);
  writer.finish(bytes);
  return bytes;
}

}  // namespace spidar
