// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_columns.h"

#include <algorithm>
#include <type_traits>
#include <zlib.h>

namespace spidar {
namespace {

/// Integers of any width as 64 bits, of which the lowest `bytes` count.
template <typename Row>
struct Column {
  const char* name;
  size_t bytes;
  bool differences;
  uint64_t (*get)(const Row& row);
  void (*set)(Row& row, uint64_t value);
};

#define SPIDAR_COLUMN(Row, name, member, differences)                          \
  {                                                                            \
    name, sizeof(Row::member), differences,                                    \
        [](const Row& row) { return static_cast<uint64_t>(row.member); },      \
        [](Row& row, uint64_t value) {                                         \
          row.member = static_cast<std::decay_t<decltype(row.member)>>(value); \
        }                                                                      \
  }

const Column<FrameRow> kFrameColumns[] = {
    SPIDAR_COLUMN(FrameRow, "stream_ns", stream_ns, true),
    SPIDAR_COLUMN(FrameRow, "duration_ns", duration_ns, true),
    SPIDAR_COLUMN(FrameRow, "moment", moment, false),
    SPIDAR_COLUMN(FrameRow, "shown", shown, false),
    SPIDAR_COLUMN(FrameRow, "anew", anew, false),
    SPIDAR_COLUMN(FrameRow, "empty", empty, false),
    SPIDAR_COLUMN(FrameRow, "turn", turn, true),
    SPIDAR_COLUMN(FrameRow, "width", width, true),
    SPIDAR_COLUMN(FrameRow, "height", height, true),
    SPIDAR_COLUMN(FrameRow, "features", features, true),
    SPIDAR_COLUMN(FrameRow, "interval_ns", interval_ns, true),
    SPIDAR_COLUMN(FrameRow, "shown_for_ns", shown_for_ns, true),
    SPIDAR_COLUMN(FrameRow, "mean_x", mean_x, false),
    SPIDAR_COLUMN(FrameRow, "mean_y", mean_y, false),
    SPIDAR_COLUMN(FrameRow, "mean_tracked", mean_tracked, true),
    SPIDAR_COLUMN(FrameRow, "votes", votes, true),
    SPIDAR_COLUMN(FrameRow, "dominant", dominant, true),
    SPIDAR_COLUMN(FrameRow, "background", background.model, false),
    SPIDAR_COLUMN(FrameRow, "shift_x", background.shift_x, false),
    SPIDAR_COLUMN(FrameRow, "shift_y", background.shift_y, false),
    SPIDAR_COLUMN(FrameRow, "linear_xx", background.linear_xx, false),
    SPIDAR_COLUMN(FrameRow, "linear_xy", background.linear_xy, false),
    SPIDAR_COLUMN(FrameRow, "linear_yx", background.linear_yx, false),
    SPIDAR_COLUMN(FrameRow, "linear_yy", background.linear_yy, false),
    SPIDAR_COLUMN(FrameRow, "perspective_x", background.perspective_x, false),
    SPIDAR_COLUMN(FrameRow, "perspective_y", background.perspective_y, false),
    SPIDAR_COLUMN(FrameRow, "sigma", background.sigma, true),
    SPIDAR_COLUMN(FrameRow, "coverage", background.coverage, true),
};

const Column<ObjectRow> kObjectColumns[] = {
    SPIDAR_COLUMN(ObjectRow, "object_frame", frame, true),
    SPIDAR_COLUMN(ObjectRow, "object_id", object.id, true),
    SPIDAR_COLUMN(ObjectRow, "object_x", object.x, true),
    SPIDAR_COLUMN(ObjectRow, "object_y", object.y, true),
    SPIDAR_COLUMN(ObjectRow, "object_width", object.width, true),
    SPIDAR_COLUMN(ObjectRow, "object_height", object.height, true),
    SPIDAR_COLUMN(ObjectRow, "object_velocity_x", object.velocity_x, false),
    SPIDAR_COLUMN(ObjectRow, "object_velocity_y", object.velocity_y, false),
    SPIDAR_COLUMN(ObjectRow, "object_growth", object.growth, false),
    SPIDAR_COLUMN(ObjectRow, "object_roll", object.roll, false),
    SPIDAR_COLUMN(ObjectRow, "object_error", object.error, false),
    SPIDAR_COLUMN(ObjectRow, "object_area", object.area, true),
    SPIDAR_COLUMN(ObjectRow, "object_prominence", object.prominence, true),
    SPIDAR_COLUMN(ObjectRow, "object_tracks", object.tracks, true),
    SPIDAR_COLUMN(ObjectRow, "object_model", object.model, false),
};

#undef SPIDAR_COLUMN

template <typename Row>
void pack(const Column<Row>& column, const std::vector<Row>& rows, MotionColumns& columns) {
  std::vector<uint8_t> plain(rows.size() * column.bytes);
  uint64_t before = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const uint64_t value = column.get(rows[i]);
    const uint64_t stored = column.differences ? value - before : value;
    for (size_t b = 0; b < column.bytes; ++b) {
      plain[b * rows.size() + i] = static_cast<uint8_t>(stored >> (8 * b));
    }
    before = value;
  }
  if (std::all_of(plain.begin(), plain.end(), [](uint8_t byte) { return byte == 0; })) return;
  uLongf size = compressBound(plain.size());
  std::vector<uint8_t>& packed = columns[column.name];
  packed.resize(size);
  compress2(packed.data(), &size, plain.data(), plain.size(), Z_BEST_COMPRESSION);
  packed.resize(size);
}

template <typename Row>
bool unpack(const Column<Row>& column, const MotionColumns& columns, std::vector<Row>& rows,
            std::vector<uint8_t>& plain) {
  const auto found = columns.find(column.name);
  plain.assign(rows.size() * column.bytes, 0);
  if (found != columns.end()) {
    uLongf size = plain.size();
    const std::vector<uint8_t>& packed = found->second;
    const int result = uncompress(plain.data(), &size, packed.data(), packed.size());
    if (result != Z_OK || size != plain.size()) return false;
  }
  uint64_t before = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    uint64_t value = 0;
    for (size_t b = 0; b < column.bytes; ++b) {
      value |= static_cast<uint64_t>(plain[b * rows.size() + i]) << (8 * b);
    }
    if (column.differences) value += before;
    column.set(rows[i], value);
    before = value;
  }
  return true;
}

}  // namespace

MotionColumns pack_columns(const MotionRows& rows) {
  MotionColumns columns;
  for (const auto& column : kFrameColumns) pack(column, rows.frames, columns);
  for (const auto& column : kObjectColumns) pack(column, rows.objects, columns);
  return columns;
}

bool unpack_columns(const MotionColumns& columns, size_t frames, size_t objects, MotionRows& rows) {
  rows.frames.assign(frames, {});
  rows.objects.assign(objects, {});
  std::vector<uint8_t> plain;
  for (const auto& column : kFrameColumns) {
    if (!unpack(column, columns, rows.frames, plain)) return false;
  }
  for (const auto& column : kObjectColumns) {
    if (!unpack(column, columns, rows.objects, plain)) return false;
  }
  return true;
}

}  // namespace spidar
