// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/frame_trace.h"

#include <string_view>
#include <strings.h>

#include "core/json_text.h"
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

Json json_of(const ImageMotion& motion) {
  return {{"velocity_px_s", json_array(motion.velocity_px_s)},
          {"growth_1_s", motion.growth_1_s},
          {"roll_rad_s", motion.roll_rad_s},
          {"tracked", motion.tracked}};
}

Json json_of(const Background& background) {
  const MotionModel& model = background.model;
  return {
      {"model", to_string(model.kind)},
      {"shift_px", json_array(model.shift_px)},
      {"linear", Json::array({json_array(model.linear.row(0)), json_array(model.linear.row(1))})},
      {"perspective_1_px", json_array(model.perspective_1_px)},
      {"sigma_px", background.sigma_px},
      {"coverage", background.coverage}};
}

Json json_of(const MovingObject& object) {
  return {{"id", object.id},
          {"position_px", json_array(object.position_px)},
          {"size_px", json_array(object.size_px)},
          {"velocity_px_s", json_array(object.relative_px_s)},
          {"error_px_s", object.error_px_s},
          {"on_screen_px_s", json_array(object.on_screen_px_s)},
          {"growth_1_s", object.growth_1_s},
          {"roll_rad_s", object.roll_rad_s},
          {"model", to_string(object.model)},
          {"points", object.points},
          {"prominence", object.prominence}};
}

}  // namespace

std::string json_line(const Frame& frame) {
  Json objects = Json::array();
  for (const MovingObject& object : frame.objects) objects.push_back(json_of(object));
  const PicturePart& area = frame.place.area;
  const Json json = {{"running_time_ns", frame.stamp.running_ns},
                     {"stream_time_ns", frame.stamp.stream_ns},
                     {"interval_ns", frame.interval_ns},
                     {"left_px", area.x},
                     {"top_px", area.y},
                     {"width_px", area.width},
                     {"height_px", area.height},
                     {"restarted", frame.picture == Likeness::kFirst},
                     {"repeated", is_again(frame.picture)},
                     {"features", frame.features},
                     {"object", frame.felt_object},
                     {"motion", json_of(frame.motion)},
                     {"wrench",
                      {{"force_N", json_array(frame.wrench.force_N)},
                       {"torque_Nm", json_array(frame.wrench.torque_Nm)}}},
                     {"background", frame.background ? json_of(*frame.background) : Json()},
                     {"objects", objects}};
  return json_text(json) + '\n';
}

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
