// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/analysis_json.h"

#include <vector>

#include "core/json_text.h"

namespace spidar {
namespace {

template <typename Vector>
Json array(const Vector& vector) {
  return std::vector<double>(vector.begin(), vector.end());
}

Json json_of(const ImageMotion& motion) {
  return {{"velocity_px_s", array(motion.velocity_px_s)},
          {"growth_1_s", motion.growth_1_s},
          {"roll_rad_s", motion.roll_rad_s},
          {"tracked", motion.tracked}};
}

Json json_of(const Background& background) {
  const MotionModel& model = background.model;
  return {{"model", to_string(model.kind)},
          {"shift_px", array(model.shift_px)},
          {"linear", Json::array({array(model.linear.row(0)), array(model.linear.row(1))})},
          {"perspective_1_px", array(model.perspective_1_px)},
          {"sigma_px", background.sigma_px},
          {"coverage", background.coverage}};
}

Json json_of(const MovingObject& object) {
  return {{"id", object.id},
          {"position_px", array(object.position_px)},
          {"size_px", array(object.size_px)},
          {"velocity_px_s", array(object.relative_px_s)},
          {"error_px_s", object.error_px_s},
          {"on_screen_px_s", array(object.on_screen_px_s)},
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
  const Json json = {
      {"running_time_ns", frame.stamp.running_ns},
      {"stream_time_ns", frame.stamp.stream_ns},
      {"interval_ns", frame.interval_ns},
      {"width_px", frame.width},
      {"height_px", frame.height},
      {"restarted", frame.picture == PictureKind::kFirst},
      {"repeated", is_again(frame.picture)},
      {"features", frame.features},
      {"object", frame.felt_object},
      {"motion", json_of(frame.motion)},
      {"wrench",
       {{"force_N", array(frame.wrench.force_N)}, {"torque_Nm", array(frame.wrench.torque_Nm)}}},
      {"background", frame.background ? json_of(*frame.background) : Json()},
      {"objects", objects}};
  return json_text(json) + '\n';
}

}  // namespace spidar
