// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What spidarmotion tells while a film is played.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gst/gst.h>

/// Of the reason why nothing is felt, in messages and `stats`: something is.
constexpr const char* kFelt = "none";

/// What a frame asks for. x is right, y up, z towards the viewer.
struct FrameRow {
  double time_s = 0;                      ///< running time at which it is shown
  bool is_measured = true;                ///< else its force is that of a haptic track
  std::array<double, 2> velocity_px_s{};  ///< zero unless it is measured
  std::array<double, 3> force_N{};
  double torque_Nm = 0;  ///< about z
  /// Why nothing of it is felt, as a word; by the newest frame that shows its picture again.
  std::string reason = kFelt;
  /// It was not compared with the frame before it: the first one, or the first after a cut or seek.
  bool begins_scene = false;
};

/// What the device does at a moment while the film plays.
struct DeviceRow {
  double time_s = 0;  ///< running time
  std::array<double, 3> force_N{};
  double torque_Nm = 0;
  std::vector<double> tension_N;  ///< of each string; 0 for those that the device does not have
};

/// Rows of a playback in the order in which they come.
class Record {
 public:
  /// Takes a message `spidar-motion`; it comes before its frame is shown.
  void add_frame(const GstStructure* message);
  /// Takes the element's `stats`; nothing of it unless a device runs.
  void add_device(const GstStructure* stats, double time_s);

  /// Without frames that show the previous picture again: its force remains.
  const std::vector<FrameRow>& frames() const { return frames_; }
  size_t repeated() const { return repeated_; }
  /// File name of the haptic track that was played last; empty if there was none.
  const std::string& track() const { return track_; }
  /// Time and word of the reason of every frame, also of those that show a picture again.
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
  size_t shown_ = 0;  ///< number of frames that shown_at() has passed
};
