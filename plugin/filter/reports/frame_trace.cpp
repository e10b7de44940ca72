// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/frame_trace.h"

#include <charconv>
#include <initializer_list>
#include <string_view>
#include <strings.h>

#include "core/analysis/analysis_json.h"

namespace spidar {
namespace {

constexpr const char* kHeader =
    "running_time_ns,stream_time_ns,features,tracked,velocity_x_px_s,velocity_y_px_s,"
    "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,limit,device_limit\n";

/// In small or capital letters.
bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() &&
         strncasecmp(text.data() + text.size() - end.size(), end.data(), end.size()) == 0;
}

template <typename Number>
void append(std::string& row, Number value) {
  char text[32];
  const std::to_chars_result end = std::to_chars(text, text + sizeof text, value);
  row.append(text, end.ptr).push_back(',');
}

}  // namespace

std::string FrameTrace::open(const std::string& path) {
  close();
  is_json_ = ends_with(path, ".jsonl");
  if (!is_json_ && !ends_with(path, ".csv")) {
    return "its name ends neither in .csv nor in .jsonl, which says what to write";
  }
  std::string reason = file_.open(path);
  if (reason.empty() && !is_json_) file_.add(kHeader);
  return reason;
}

void FrameTrace::append_csv(const FrameReport& report) {
  const Frame& frame = report.frame;
  append(line_, frame.running_ns);
  append(line_, frame.stream_ns);
  append(line_, frame.features);
  append(line_, frame.motion.tracked);
  const Eigen::Vector2d& velocity = frame.motion.velocity_px_s;
  const Eigen::Vector3d& force = frame.wrench.force_N;
  const Eigen::Vector3d& torque = frame.wrench.torque_Nm;
  for (double value : {velocity.x(), velocity.y(), force.x(), force.y(), force.z(), torque.x(),
                       torque.y(), torque.z()}) {
    append(line_, value);
  }
  line_.append(nick(report.limit)).append(",");
  line_.append(nick(report.device_limit)).append("\n");
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

}  // namespace spidar
