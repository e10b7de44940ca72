// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/frame_trace.h"

#include <string_view>
#include <strings.h>

#include "core/analysis/analysis_json.h"
#include "spidar/realtime/line_writer.h"

namespace spidar::filter {
namespace {

constexpr const char* kHeader =
    "running_time_ns,stream_time_ns,features,tracked,velocity_x_px_s,velocity_y_px_s,"
    "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,no_force_reason,"
    "device_no_force_reason\n";
// What files of every version begin with.
constexpr const char* kFirstColumn = "running_time_ns,";
constexpr const char* kFirstKey = "{\"running_time_ns\":";

/// In small or capital letters.
bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() &&
         strncasecmp(text.data() + text.size() - end.size(), end.data(), end.size()) == 0;
}

}  // namespace

std::string FrameTrace::open(const std::string& path) {
  close();
  is_json_ = ends_with(path, ".jsonl");
  if (!is_json_ && !ends_with(path, ".csv")) {
    return "its name ends neither in .csv nor in .jsonl, which says what to write";
  }
  std::string reason = file_.open(path, is_json_ ? kFirstKey : kFirstColumn);
  if (reason.empty() && !is_json_) file_.add(kHeader);
  return reason;
}

void FrameTrace::append_csv(const FrameReport& report) {
  const Frame& frame = report.frame;
  const Eigen::Vector2d& velocity = frame.motion.velocity_px_s;
  CsvRow(line_)
      .number(frame.stamp.running_ns)
      .number(frame.stamp.stream_ns)
      .number(frame.features)
      .number(frame.motion.tracked)
      .number(velocity.x())
      .number(velocity.y())
      .wrench(frame.wrench)
      .field(nick(report.no_force))
      .field(nick(report.device_no_force));
  line_ += '\n';
}

int FrameTrace::write(const FrameReport& report) {
  if (!file_.is_open()) return 0;
  line_.clear();
  if (is_json_) {
    line_ = json_line(report.frame);
  } else {
    append_csv(report);
  }
  file_.add(line_);
  return file_.status().error;
}

}  // namespace spidar::filter
