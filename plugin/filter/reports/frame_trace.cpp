// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/frame_trace.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <initializer_list>
#include <string_view>
#include <strings.h>
#include <utility>

#include "core/analysis/analysis_json.h"
#include "spidar/realtime/standard_descriptors.h"

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
  std::string reason;
  const int opened = open_own_output(path.c_str(), reason);
  if (opened < 0) return reason;
  file_ = fdopen(opened, "w");
  if (!file_) {
    reason = std::strerror(errno);
    ::close(opened);
    return reason;
  }
  line_ = is_json_ ? "" : kHeader;
  const SigpipeBlock no_sigpipe;
  if (!put() || std::fflush(file_) != 0) {
    reason = std::strerror(errno);
    close();
    return reason;
  }
  return {};
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

bool FrameTrace::write(const FrameReport& report) {
  line_.clear();
  if (is_json_) {
    line_ = json_line(report.frame);
  } else {
    append_csv(report);
  }
  if (put()) return true;
  close();
  return false;
}

bool FrameTrace::put() {
  const SigpipeBlock no_sigpipe;
  return std::fwrite(line_.data(), 1, line_.size(), file_) == line_.size();
}

bool FrameTrace::close() {
  if (!file_) return true;
  const SigpipeBlock no_sigpipe;
  return std::fclose(std::exchange(file_, nullptr)) == 0;
}

}  // namespace spidar
