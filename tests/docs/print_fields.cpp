// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What users read of frames, ticks and devices, for docs/elements.py: a line for each row of a
// record, with its list, key, name, type and unit, and meaning, separated by tabs.
#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include <gst/gst.h>

#include "core/fields.h"
#include "plugin/device/device_warnings.h"
#include "plugin/filter/motion_state.h"
#include "plugin/frame/frame_fields.h"
#include "plugin/tracks/track_input.h"
#include "spidar/loop/tick_trace.h"

namespace spidar {
namespace {

class Rows : public FieldSink {
 public:
  enum class Names { kFields, kColumns, kKeys };
  Rows(std::string list, Names names, unsigned outputs = 0, std::string prefix = "")
      : FieldSink(outputs), list_(std::move(list)), names_(names), prefix_(std::move(prefix)) {}

  void begin(const char* group) override { group_ = std::string(group) + '.'; }
  void end() override { group_.clear(); }

 private:
  void write(const Field& field, const FieldValue& value) override {
    const auto* const parts = std::get_if<Parts>(&value);
    std::string name = field.name;
    std::string facts;
    if (names_ == Names::kFields) {
      constexpr std::array kTypes{"boolean", "int", "uint", "uint64", "uint64", "double", "string"};
      const auto* const scalar = parts ? &parts->front().second : std::get_if<Scalar>(&value);
      facts = scalar ? kTypes.at(scalar->index()) : "array";
      if (*field.unit != '\0') facts += std::string(", ") + field.unit;
      if (parts) name += "-*";
    } else if (names_ == Names::kColumns) {
      name = field.column(parts ? "*" : "");
    } else {
      name = prefix_ + group_ + field.column();
    }
    std::printf("%s\t%s\t%s\t%s\t%s\n", list_.c_str(), field.name, name.c_str(), facts.c_str(),
                field.meaning);
  }

  const std::string list_;
  const Names names_;
  const std::string prefix_;
  std::string group_;
};

void print_all(filter::MotionState& state) {
  using Names = Rows::Names;
  Rows message("message", Names::kFields, kInMessage);
  frame_fields({}, {}, message);
  Rows device_message("device-message", Names::kFields);
  device_message_fields("", "", "", device_message);
  Rows stats("stats", Names::kFields, kInMessage);
  state.describe(stats);
  Rows device("stats.device", Names::kFields);
  state.feed.output.describe(device);
  Rows track("stats.track", Names::kFields);
  tracks::sample_fields(0, {}, 0, track);
  Rows csv("trace", Names::kColumns, kInCsv);
  frame_fields({}, {}, csv);
  Rows json("json", Names::kKeys, kInJson);
  frame_fields({}, {}, json);
  Rows background("json", Names::kKeys, 0, "background.");
  background_fields({}, background);
  Rows object("json", Names::kKeys, 0, "objects[].");
  object_fields({}, object);
  Rows tick("haptic-trace", Names::kColumns);
  tick_fields({}, tick);
}

}  // namespace
}  // namespace spidar

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  GstElement* const element = GST_ELEMENT(g_object_new(GST_TYPE_SPIDAR_MOTION, nullptr));
  gst_element_set_state(element, GST_STATE_READY);  // opens the device "sim"
  spidar::print_all(gst_spidar_motion_state(GST_SPIDAR_MOTION(element)));
  gst_element_set_state(element, GST_STATE_NULL);
  gst_object_unref(element);
  return 0;
}
