// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gst/gst.h>

/// The reason `none` in messages and `stats`: something is felt.
constexpr const char* kFelt = "none";

/// The wrench of a frame. x is right, y up, z towards the viewer.
struct FrameRow {
  double time_s = 0;                      ///< running time at which the frame is shown
  bool is_measured = true;                ///< otherwise the force is that of a haptic track
  std::array<double, 2> velocity_px_s{};  ///< zero unless measured
  std::array<double, 3> force_N{};
  double torque_Nm = 0;  ///< about z
  /// Why nothing is felt, as a word; from the newest frame that repeats the picture.
  std::string reason = kFelt;
  /// Whether there was no frame to compare with: the first one, or the first after a cut or seek.
  bool begins_scene = false;
};

/// What the device does at a moment while the film plays.
struct DeviceRow {
  double time_s = 0;  ///< running time
  std::array<double, 3> force_N{};
  double torque_Nm = 0;
  std::vector<double> tension_N;  ///< of each string; 0 for missing strings
};

/// What spidarmotion reports while a film is played, in order.
class Record {
 public:
  /// Adds the frame of a message `spidar-motion`, which comes before the frame is shown.
  void add_frame(const GstStructure* message);
  /// Adds a row from the element's `stats`, if a device runs.
  void add_device(const GstStructure* stats, double time_s);

  /// The frames without those that repeat a picture, whose force remains.
  const std::vector<FrameRow>& frames() const { return frames_; }
  size_t repeated() const { return repeated_; }
  /// The file name of the last haptic track; empty if there was none.
  const std::string& track() const { return track_; }
  /// Time and word of the reason of every frame, also of repetitions.
  const std::vector<std::pair<double, std::string>>& reasons() const { return reasons_; }
  /// Running times of the first and the last frame, else of the device's rows; 0 without any.
  std::pair<double, double> span_s() const;
  const std::vector<DeviceRow>& devices() const { return devices_; }
  /// The sentence for the word of a reason; the word itself if no sentence is known.
  std::string sentence(const std::string& reason) const;

  /// The newest frame that has been shown at this running time; null before the first.
  const FrameRow* shown_at(double time_s);

 private:
  std::vector<FrameRow> frames_;
  std::vector<DeviceRow> devices_;
  std::vector<std::pair<double, std::string>> reasons_;
  std::map<std::string, std::string> sentences_;
  std::string track_;
  size_t repeated_ = 0;
  size_t shown_ = 0;  ///< the number of frames that shown_at() has passed
};
