// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/frame_trace.h"

#include <string_view>
#include <strings.h>
#include <variant>

#include "core/json_text.h"
#include "plugin/frame/frame_fields.h"

namespace spidar::filter {
namespace {

// Every trace, of any version, begins with one of these.
constexpr const char* kFirstColumn = "running_time_ns,";
constexpr const char* kFirstKey = "{\"running_time_ns\":";

/// Ignores case.
bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() &&
         strncasecmp(text.data() + text.size() - end.size(), end.data(), end.size()) == 0;
}

class JsonFields : public FieldSink {
 public:
  explicit JsonFields(Json& json) : FieldSink(kInJson), json_(json) {}

  void begin(const char* group) override { group_ = group; }
  void end() override { group_ = nullptr; }

 private:
  void write(const Field& field, const FieldValue& value) override {
    Json& json = (group_ ? json_[group_] : json_)[field.column()];
    if (const auto* const scalar = std::get_if<Scalar>(&value)) {
      json = json_of(*scalar);
    } else if (const auto* const parts = std::get_if<Parts>(&value)) {
      for (const auto& [part, number] : *parts) json.push_back(json_of(number));
    } else {
      const auto& matrix = std::get<Eigen::MatrixXd>(value);
      for (const auto& row : matrix.rowwise()) json.push_back(json_array(row));
    }
  }
  static Json json_of(const Scalar& scalar) {
    return std::visit([](auto value) { return Json(value); }, scalar);
  }

  Json& json_;
  const char* group_ = nullptr;
};

}  // namespace

std::string json_line(const FrameReport& report) {
  Json json;
  JsonFields to(json);
  frame_fields(report, {}, to);
  Json& background = json["background"];
  if (report.frame.background) {
    JsonFields to_background(background);
    background_fields(*report.frame.background, to_background);
  }
  Json& objects = json["objects"] = Json::array();
  for (const MovingObject& object : report.frame.objects) {
    JsonFields to_object(objects.emplace_back());
    object_fields(object, to_object);
  }
  return json_text(json) + '\n';
}

std::string FrameTrace::open(const std::string& path) {
  close();
  is_json_ = ends_with(path, ".jsonl");
  if (!is_json_ && !ends_with(path, ".csv")) {
    return "its name ends neither in .csv nor in .jsonl, which says what to write";
  }
  std::string reason = file_.open(path, is_json_ ? kFirstKey : kFirstColumn);
  if (reason.empty() && !is_json_) add_line({}, CsvLine::Of::kNames);
  return reason;
}

void FrameTrace::add_line(const FrameReport& report, CsvLine::Of of) {
  line_.clear();
  CsvLine to(of, line_, kInCsv);
  frame_fields(report, {}, to);
  line_ += '\n';
  file_.add(line_);
}

int FrameTrace::write(const FrameReport& report) {
  if (!file_.is_open()) return 0;
  if (is_json_) {
    file_.add(json_line(report));
  } else {
    add_line(report, CsvLine::Of::kValues);
  }
  return file_.status().error;
}

}  // namespace spidar::filter
