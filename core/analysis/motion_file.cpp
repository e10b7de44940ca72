// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_file.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/analysis/cbor_items.h"
#include "core/analysis/motion_columns.h"
#include "core/force/motion_bounds.h"

namespace spidar {
namespace {

constexpr const char* kFormat = "gst-spidar motion";
/// A picture has at most ObjectTracker::kMostObjects; a file that says more is damaged.
constexpr int64_t kMostObjects = 64 * static_cast<int64_t>(MotionFileWriter::kChunkFrames);
constexpr uint32_t kLargestSide_px = 65536;
constexpr uint8_t kTurns = 8;
constexpr int64_t kMostPieces = 1 << 20;
/// 36 years: no film has later times, and differences of two such times do not overflow.
constexpr int64_t kLatest_ns = int64_t{1} << 60;

[[noreturn]] void cut_off() {
  throw MotionFileError("its end is missing: analyse the film again");
}

[[noreturn]] void damaged() {
  throw MotionFileError("it is damaged: analyse the film again");
}

uint8_t turn_code(const PictureTurn& turn) {
  const Eigen::Vector2d x(1, 0), y(0, 1);
  for (int code = 0; code < kTurns; ++code) {
    const PictureTurn other(code % 4, code >= 4);
    if (other.to_shown(x) == turn.to_shown(x) && other.to_shown(y) == turn.to_shown(y)) {
      return static_cast<uint8_t>(code);
    }
  }
  return 0;
}

uint64_t bits_of(double value) {
  uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double from_bits(uint64_t bits) {
  double value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

FrameRow row_of(const MotionMoment& moment, const MeasuredFrame& frame) {
  FrameRow row;
  row.stream_ns = moment.stream_ns;
  row.duration_ns = moment.duration_ns;
  row.moment = static_cast<uint8_t>(moment.kind);
  row.empty = moment.empty;
  row.turn = turn_code(moment.turn);
  if (moment.kind != MomentKind::kFrame) return row;
  row.shown = static_cast<uint8_t>(frame.shown);
  row.anew = frame.anew;
  if (frame.shown == Shown::kWaiting) return row;
  row.width = static_cast<uint32_t>(frame.width);
  row.height = static_cast<uint32_t>(frame.height);
  row.features = static_cast<uint32_t>(frame.features);
  row.interval_ns = frame.interval_ns;
  row.shown_for_ns = frame.shown_for_ns;
  row.mean_x = bits_of(frame.mean.velocity_px_s.x());
  row.mean_y = bits_of(frame.mean.velocity_px_s.y());
  row.mean_tracked = static_cast<uint32_t>(frame.mean.tracked);
  row.votes = static_cast<uint32_t>(frame.votes);
  row.dominant = frame.dominant;
  row.background = encode_background(frame.background, longer_side_px(frame));
  return row;
}

bool is_sound(const FrameRow& row) {
  if (row.moment >= kMoments || row.turn >= kTurns || row.stream_ns < 0 ||
      row.stream_ns > kLatest_ns || row.duration_ns < -1 || row.duration_ns > kLatest_ns) {
    return false;
  }
  if (row.moment != static_cast<uint8_t>(MomentKind::kFrame)) return true;
  const auto shown = static_cast<Shown>(row.shown);
  if (shown == Shown::kWaiting) return true;
  const auto sound_side = [](uint32_t side) { return side > 0 && side <= kLargestSide_px; };
  const bool has_interval = row.interval_ns >= kLeastInterval_ns && row.shown_for_ns > 0;
  const uint32_t counts = row.features | row.mean_tracked | row.votes;
  return shown <= Shown::kOther && sound_side(row.width) && sound_side(row.height) &&
         counts <= INT32_MAX && row.background.model <= kModelKinds &&
         (shown == Shown::kFirst || has_interval);
}

}  // namespace

std::string wrong_motion(const MotionHeader& header, MotionKind motion) {
  const MotionPiece& piece = header.piece;
  if (piece.of > 0) {
    return "it is piece " + std::to_string(piece.number) + " of " + std::to_string(piece.of) +
           " of an analysis: spidartrack join makes one of all";
  }
  const bool is_mean = motion == MotionKind::kMean;
  if (is_mean == header.is_mean) return {};
  return is_mean ? "motion=mean measures other things, by spidartrack analyze FILM -- motion=mean"
                 : "it was measured for motion=mean, and of camera and objects it knows nothing";
}

std::string write_header(const MotionHeader& header) {
  CborItem item;
  item.texts["format"] = kFormat;
  item.numbers["version"] = MotionHeader::kVersion;
  item.texts["film"] = header.film;
  item.texts["settings"] = header.settings;
  item.numbers["mean"] = header.is_mean;
  if (const MotionPiece& piece = header.piece; piece.of > 0) {
    item.numbers["piece"] = piece.number;
    item.numbers["pieces"] = piece.of;
    item.numbers["film_ns"] = piece.film_ns;
    item.numbers["has_end"] = piece.has_end;
    item.texts["program"] = piece.program;
    item.texts["format_of_track"] = piece.format;
  }
  return write_cbor(item);
}

MotionHeader read_header(std::istream& file) {
  const std::optional<CborItem> item = read_cbor(file);
  if (!item || item->text("format") != kFormat) {
    throw MotionFileError(
        "it is no analysis of a film: spidartrack analyze FILM writes one to FILM.motion");
  }
  const int64_t version = item->number("version").value_or(0);
  if (version != MotionHeader::kVersion) {
    throw MotionFileError("it has version " + std::to_string(version) +
                          " of the format, and this program reads version " +
                          std::to_string(MotionHeader::kVersion) + ": analyse the film again");
  }
  MotionHeader header{
      item->text("film"), item->text("settings"), item->number("mean").value_or(0) != 0, {}};
  MotionPiece& piece = header.piece;
  piece.of =
      static_cast<int>(std::clamp<int64_t>(item->number("pieces").value_or(0), 0, kMostPieces));
  if (piece.of == 0) return header;
  piece.number =
      static_cast<int>(std::clamp<int64_t>(item->number("piece").value_or(0), 0, kMostPieces));
  piece.film_ns = item->number("film_ns").value_or(0);
  piece.has_end = item->number("has_end").value_or(0) != 0;
  piece.program = item->text("program");
  piece.format = item->text("format_of_track");
  return header;
}

void MotionFileWriter::add(const MotionMoment& moment, const MeasuredFrame& frame,
                           std::string& bytes) {
  std::vector<ObjectCode> objects;
  if (moment.kind == MomentKind::kFrame && frame.shown != Shown::kWaiting) {
    for (const MovingObject& object : frame.objects) {
      objects.push_back(encode_object(object, longer_side_px(frame)));
    }
  }
  add(row_of(moment, frame), objects, bytes);
}

void MotionFileWriter::add(const FrameRow& row, const std::vector<ObjectCode>& objects,
                           std::string& bytes) {
  const auto index = static_cast<uint32_t>(rows_.frames.size());
  rows_.frames.push_back(row);
  for (const ObjectCode& object : objects) rows_.objects.push_back({index, object});
  if (rows_.frames.size() == kChunkFrames) write_chunk(bytes);
}

void MotionFileWriter::write_chunk(std::string& bytes) {
  std::stable_sort(
      rows_.objects.begin(), rows_.objects.end(),
      [](const ObjectRow& a, const ObjectRow& b) { return a.object.id < b.object.id; });
  CborItem item;
  item.numbers["frames"] = static_cast<int64_t>(rows_.frames.size());
  item.numbers["objects"] = static_cast<int64_t>(rows_.objects.size());
  item.binaries = pack_columns(rows_);
  bytes += write_cbor(item);
  written_ += rows_.frames.size();
  rows_.frames.clear();
  rows_.objects.clear();
}

void MotionFileWriter::finish(std::string& bytes) {
  if (!rows_.frames.empty()) write_chunk(bytes);
  CborItem end;
  end.numbers["end"] = static_cast<int64_t>(written_);
  bytes += write_cbor(end);
}

MotionFile::MotionFile(std::istream& file) : header_(read_header(file)) {
  while (true) {
    if (file.peek() == std::istream::traits_type::eof()) cut_off();
    const std::optional<CborItem> item = read_cbor(file);
    if (!item) {
      if (file.peek() == std::istream::traits_type::eof()) cut_off();
      damaged();
    }
    if (const std::optional<int64_t> end = item->number("end")) {
      if (*end != static_cast<int64_t>(size())) damaged();
      break;
    }
    const int64_t frames = item->number("frames").value_or(0);
    const int64_t objects = item->number("objects").value_or(-1);
    const bool is_chunk =
        frames > 0 && frames <= static_cast<int64_t>(MotionFileWriter::kChunkFrames);
    MotionRows chunk;
    if (!is_chunk || objects < 0 || objects > kMostObjects ||
        !unpack_columns(item->binaries, static_cast<size_t>(frames), static_cast<size_t>(objects),
                        chunk)) {
      damaged();
    }
    add_chunk(std::move(chunk));
  }
}

/// Puts the objects behind each other frame by frame.
void MotionFile::add_chunk(MotionRows chunk) {
  const size_t frames = chunk.frames.size();
  if (!std::all_of(chunk.frames.begin(), chunk.frames.end(), is_sound)) damaged();
  std::vector<size_t> place(frames + 1, 0);
  for (const ObjectRow& row : chunk.objects) {
    if (row.frame >= frames || row.object.model >= kModelKinds) damaged();
    ++place[row.frame + 1];
  }
  for (size_t i = 0; i < frames; ++i) place[i + 1] += place[i];
  const size_t before = rows_.objects.size();
  if (first_object_.empty()) first_object_.push_back(0);
  for (size_t i = 0; i < frames; ++i) {
    if (place[i + 1] > place[i] && chunk.frames[i].background.model == 0) damaged();
    first_object_.push_back(before + place[i + 1]);
  }
  rows_.objects.resize(before + chunk.objects.size());
  for (const ObjectRow& row : chunk.objects) rows_.objects[before + place[row.frame]++] = row;
  rows_.frames.insert(rows_.frames.end(), chunk.frames.begin(), chunk.frames.end());
}

MotionMoment MotionFile::moment(size_t i) const {
  const FrameRow& row = rows_.frames[i];
  return {static_cast<MomentKind>(row.moment), row.stream_ns, row.duration_ns, row.empty != 0,
          PictureTurn(row.turn % 4, row.turn >= 4)};
}

std::vector<ObjectCode> MotionFile::objects(size_t i) const {
  std::vector<ObjectCode> objects;
  for (size_t k = first_object_[i]; k < first_object_[i + 1]; ++k) {
    objects.push_back(rows_.objects[k].object);
  }
  return objects;
}

void MotionFile::load(size_t i, MeasuredFrame& frame) const {
  const FrameRow& row = rows_.frames[i];
  frame.shown = static_cast<Shown>(row.shown);
  frame.anew = row.anew != 0;
  frame.tracks = nullptr;
  if (frame.shown == Shown::kWaiting) return;
  frame.width = static_cast<int>(row.width);
  frame.height = static_cast<int>(row.height);
  frame.features = static_cast<int>(row.features);
  frame.interval_ns = row.interval_ns;
  frame.shown_for_ns = row.shown_for_ns;
  frame.mean = {};
  frame.mean.velocity_px_s = {from_bits(row.mean_x), from_bits(row.mean_y)};
  frame.mean.tracked = static_cast<int>(row.mean_tracked);
  frame.votes = static_cast<int>(row.votes);
  frame.dominant = row.dominant;
  const double side_px = longer_side_px(frame);
  const double interval_s = static_cast<double>(row.interval_ns) * 1e-9;
  frame.background = decode_background(row.background, side_px);
  frame.objects.clear();
  for (size_t k = first_object_[i]; k < first_object_[i + 1]; ++k) {
    frame.objects.push_back(
        decode_object(rows_.objects[k].object, side_px, *frame.background, interval_s));
  }
}

}  // namespace spidar
