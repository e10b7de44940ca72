// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Collects the data of one playback, in memory that does not grow with its length.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "apps/play/histogram.h"
#include "apps/play/series.h"
#include "apps/play/skew.h"
#include "apps/play/trace_reader.h"

constexpr size_t kStrings = 8;

/// The latest state, for a line of progress.
struct Now {
  int64_t running_ns = 0;
  double speed_px_s = 0;
  double force_N[3] = {};  ///< at the grip: x right, y up, z towards the viewer
  std::string device = "closed";
};

/// Any member may be called from any thread.
class SessionRecord {
 public:
  static std::vector<std::string> motion_columns();
  static std::vector<std::string> haptic_columns();

  /// Takes a row of each trace with these columns.
  void add_motion(const TraceReader::Fields& row);
  void add_haptic(const TraceReader::Fields& row);
  void add_shown(int64_t running_ns, int64_t monotonic_ns);

  Now now() const;

  /// For use after the playback, by one thread: the numbers to print and the curves to draw.
  struct Numbers {
    uint64_t frames = 0;  ///< with a force of their own: analysed, or of a track
    uint64_t shown = 0;
    double duration_s = 0;  ///< of the video that was played
    /// Number of frames, by the nick of spidar::NoForceReason.
    std::map<std::string, uint64_t> limits;
    Histogram speed_px_s;
    Histogram wanted_N;       ///< output of the controller, for each frame
    Histogram delivered_N;    ///< delivered by the strings, for each tick
    uint64_t ticks = 0;       ///< while playing
    uint64_t felt_ticks = 0;  ///< ticks with kFeltForce_N or more
    Histogram lateness_ms;    ///< of the loop's wake-up
    Skew skew;
    /// The largest force towards the viewer and the largest torque about z, wanted or at the grip.
    double largest_depth_N = 0, largest_roll_Nm = 0;
    /// Position [px] and velocity [px/s], x and y of each; wanted force x, y, z [N] and torque
    /// about z [Nm].
    Series<8> frames_curve;
    Series<4 + kStrings> ticks_curve;  ///< the same force and torque at the grip; tensions [N]
  };
  const Numbers& numbers() const { return numbers_; }

 private:
  mutable std::mutex mutex_;
  Numbers numbers_;
  Now now_;
  /// Force and torque about z, wanted or delivered.
  void note_largest(double depth_N, double roll_Nm);

  double position_px_[2] = {0, 0};
  int64_t first_frame_ns_ = -1;
  int64_t last_frame_ns_ = -1;
};
