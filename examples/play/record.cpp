// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/play/record.h"

#include <filesystem>

namespace {

double number_of(const GstStructure* structure, const char* name) {
  double value = 0;
  gst_structure_get_double(structure, name, &value);
  return value;
}

std::string text_of(const GstStructure* structure, const char* name) {
  const char* const text = gst_structure_get_string(structure, name);
  return text ? text : "";
}

std::array<double, 3> force_of(const GstStructure* structure) {
  return {number_of(structure, "force-x"), number_of(structure, "force-y"),
          number_of(structure, "force-z")};
}

}  // namespace

void Record::add_frame(const GstStructure* message) {
  guint64 running_ns = GST_CLOCK_TIME_NONE;
  gst_structure_get_uint64(message, "running-time", &running_ns);
  if (running_ns == GST_CLOCK_TIME_NONE) return;
  FrameRow row;
  row.time_s = 1e-9 * static_cast<double>(running_ns);
  // After a seek the running time begins again, and the record with it.
  if (!frames_.empty() && row.time_s < frames_.back().time_s) {
    frames_.clear();
    devices_.clear();
    reasons_.clear();
    shown_ = 0;
  }
  const std::string track = text_of(message, "track");
  row.is_measured = track.empty();
  if (!track.empty()) track_ = std::filesystem::path(track).filename();
  // In the picture y points down.
  if (row.is_measured) {
    row.velocity_px_s = {number_of(message, "velocity-x"), -number_of(message, "velocity-y")};
  }
  row.force_N = force_of(message);
  row.torque_Nm = number_of(message, "torque-z");
  row.begins_scene = frames_.empty() || text_of(message, "no-force-reason") == "nothing-to-compare";
  // The film's own reason comes first: a device cannot exert a force that no frame causes.
  for (const std::string of : {"", "device-"}) {
    const std::string word = text_of(message, (of + "no-force-reason").c_str());
    // The first frames are analysed before the pipeline plays and the device runs.
    if (word == "not-playing" || word == "device-starting") continue;
    if (word.empty() || word == kFelt || row.reason != kFelt) continue;
    row.reason = word;
    sentences_[word] = text_of(message, (of + "no-force-text").c_str());
  }
  reasons_.emplace_back(row.time_s, row.reason);
  gboolean repeated = FALSE;
  if (gst_structure_get_boolean(message, "repeated", &repeated) && repeated) {
    ++repeated_;
    if (!frames_.empty()) frames_.back().reason = row.reason;
    return;
  }
  frames_.push_back(row);
}

void Record::add_device(const GstStructure* stats, double time_s) {
  if (text_of(stats, "device-state") != "running") return;
  DeviceRow row;
  row.time_s = time_s;
  row.force_N = force_of(stats);
  row.torque_Nm = number_of(stats, "torque-z");
  const GValue* const tensions = gst_structure_get_value(stats, "tensions");
  for (guint i = 0; tensions && i < gst_value_array_get_size(tensions); ++i) {
    row.tension_N.push_back(g_value_get_double(gst_value_array_get_value(tensions, i)));
  }
  devices_.push_back(row);
}

std::string Record::sentence(const std::string& reason) const {
  const auto found = sentences_.find(reason);
  return found == sentences_.end() || found->second.empty() ? reason : found->second;
}

std::pair<double, double> Record::span_s() const {
  if (!reasons_.empty()) return {reasons_.front().first, reasons_.back().first};
  if (!devices_.empty()) return {devices_.front().time_s, devices_.back().time_s};
  return {0, 0};
}

const FrameRow* Record::shown_at(double time_s) {
  while (shown_ < frames_.size() && frames_[shown_].time_s <= time_s) ++shown_;
  return shown_ == 0 ? nullptr : &frames_[shown_ - 1];
}
