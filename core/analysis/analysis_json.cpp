// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/analysis_json.h"

#include <charconv>
#include <cmath>
#include <type_traits>

namespace spidar {
namespace {

/// Appends JSON text and puts the commas between members.
class Writer {
 public:
  explicit Writer(std::string& text) : text_(text) {}

  Writer& open(char bracket) {
    separate();
    text_ += bracket;
    return *this;
  }
  Writer& close(char bracket) {
    text_ += bracket;
    return *this;
  }
  Writer& key(const char* name) {
    separate();
    text_.append(1, '"').append(name).append("\":");
    return *this;
  }
  /// A number, true, false, null or a name that needs no escapes.
  template <typename Number>
  Writer& value(Number number) {
    if constexpr (std::is_floating_point_v<Number>) {
      if (!std::isfinite(number)) return literal("null");
    }
    separate();
    char digits[32];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
    return *this;
  }
  Writer& value(bool yes) { return literal(yes ? "true" : "false"); }
  Writer& value(const char* name) {
    separate();
    text_.append(1, '"').append(name).append(1, '"');
    return *this;
  }
  template <int kSize>
  Writer& value(const Eigen::Matrix<double, kSize, 1>& vector) {
    open('[');
    for (int i = 0; i < kSize; ++i) value(vector[i]);
    return close(']');
  }
  Writer& literal(const char* word) {
    separate();
    text_ += word;
    return *this;
  }
  template <typename Value>
  Writer& field(const char* name, const Value& what) {
    return key(name).value(what);
  }

 private:
  void separate() {
    const char last = text_.empty() ? '\n' : text_.back();
    if (last != '{' && last != '[' && last != ':' && last != '\n') text_ += ',';
  }

  std::string& text_;
};

void write(Writer& json, const ImageMotion& motion) {
  json.open('{')
      .field("velocity_px_s", motion.velocity_px_s)
      .field("growth_1_s", motion.growth_1_s)
      .field("roll_rad_s", motion.roll_rad_s)
      .field("tracked", motion.tracked)
      .close('}');
}

void write(Writer& json, const Background& background) {
  const MotionModel& model = background.model;
  json.open('{').field("model", to_string(model.kind)).field("shift_px", model.shift_px);
  json.key("linear").open('[');
  for (int i = 0; i < 2; ++i) json.value(Eigen::Vector2d(model.linear.row(i)));
  json.close(']')
      .field("perspective_1_px", model.perspective_1_px)
      .field("sigma_px", background.sigma_px)
      .field("coverage", background.coverage)
      .close('}');
}

void write(Writer& json, const MovingObject& object) {
  json.open('{')
      .field("id", object.id)
      .field("position_px", object.position_px)
      .field("size_px", object.size_px)
      .field("velocity_px_s", object.relative_px_s)
      .field("error_px_s", object.error_px_s)
      .field("on_screen_px_s", object.on_screen_px_s)
      .field("growth_1_s", object.growth_1_s)
      .field("roll_rad_s", object.roll_rad_s)
      .field("model", to_string(object.model))
      .field("tracks", object.tracks)
      .field("prominence", object.prominence)
      .close('}');
}

void write_points(Writer& json, const Frame& frame) {
  const auto middle_x_px = static_cast<float>(frame.width - 1) / 2;
  const auto middle_y_px = static_cast<float>(frame.height - 1) / 2;
  json.key("points").open('[');
  for (const Track& track : frame.tracks) {
    json.open('[')
        .value(track.id)
        .value(track.to.x_px - middle_x_px)
        .value(track.to.y_px - middle_y_px)
        .value(track.to.x_px - track.from.x_px)
        .value(track.to.y_px - track.from.y_px)
        .close(']');
  }
  json.close(']');
}

}  // namespace

void append_json(const Frame& frame, const JsonOptions& options, std::string& line) {
  Writer json(line);
  json.open('{')
      .field("running_time_ns", frame.running_ns)
      .field("stream_time_ns", frame.stream_ns)
      .field("interval_ns", frame.interval_ns)
      .field("width_px", frame.width)
      .field("height_px", frame.height)
      .field("restarted", frame.picture == PictureKind::kFirst)
      .field("repeated", is_again(frame.picture))
      .field("features", frame.features)
      .field("object", frame.felt_object);
  write(json.key("motion"), frame.motion);
  json.key("wrench")
      .open('{')
      .field("force_N", frame.wrench.force_N)
      .field("torque_Nm", frame.wrench.torque_Nm)
      .close('}');
  json.key("background");
  if (frame.background) {
    write(json, *frame.background);
  } else {
    json.literal("null");
  }
  json.key("objects").open('[');
  for (const MovingObject& object : frame.objects) write(json, object);
  json.close(']');
  if (options.points) write_points(json, frame);
  json.close('}');
  line += '\n';
}

}  // namespace spidar
