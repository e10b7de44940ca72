// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <deque>
#include <vector>

#include "core/wrench.h"
#include "plugin/window/view/window_view.h"
#include "spidar/loop/tick_record.h"

namespace spidar::window {

/// Whether two forces show the same number, which has one decimal.
inline bool are_same(const Wrench& wanted, const Wrench& delivered) {
  constexpr double kShown_per_N = 10;
  return std::lround(kShown_per_N * wanted.force_N.norm()) ==
         std::lround(kShown_per_N * delivered.force_N.norm());
}

/// The values of one moment that the plots of speed show. Times are those of CLOCK_MONOTONIC.
struct Moment {
  double time_s = 0;
  double interval_s = 0;  ///< since the previous frame when a new one has come, otherwise 0
  double speed_px_s = 0;  ///< in the reference frame, before the filter
  Wrench wanted;          ///< by the controller, of the newest frame
  Wrench felt;            ///< delivered at the grip; zero without a device
};

/// The forces of the milliseconds in one pixel's width of a plot, and since the pixel before.
struct ForceColumn {
  bool is_empty = true;
  Eigen::Vector3d wanted_low_N, wanted_high_N, delivered_low_N, delivered_high_N;  ///< by axis
  double most_N = 0;  ///< magnitude of the largest delivered force
};

/// Records moments and forces of the last minute.
class Timeline {
 public:
  static constexpr double kMemory_s = 60;  ///< older moments are forgotten
  static constexpr double kPlotted_s = 5;  ///< what the plots show at first, up to the newest
  static constexpr double kMinPlotted_s = 0.5, kMaxPlotted_s = 20;

  /// Adds a moment; times must rise.
  void add(const Moment& moment);
  /// Adds a force of a device; times must rise.
  void add(const ForceTick& tick);
  /// Discards the recorded data, because another stream begins.
  void clear();

  /// The time of the newest moment; 0 when there is none.
  double newest_s() const { return moments_.empty() ? 0 : moments_.back().time_s; }
  /// Oldest first.
  const std::deque<Moment>& moments() const { return moments_; }
  /// How many seconds an axis from the oldest moment on must show: at least what the plots show,
  /// and the whole memory once most of it is full. One of few round numbers.
  double remembered_s() const;
  double plotted_s() const { return plotted_s_; }
  void zoom(double factor);
  std::vector<Moment> plotted() const;
  /// The lowest and highest forces in each of `count` equal parts of a time.
  std::vector<ForceColumn> columns(double from_s, double to_s, size_t count) const;
  /// Force in N at `points` speeds from 0 to `highest_px_s`, of a controller that has adapted to
  /// the recorded data: the linear one to the largest speed since the stream began (eq. 13), the
  /// adaptive one to what the plots show. Empty when the settings are out of range.
  std::vector<double> gain_curve(const ControllerSettings& settings, double highest_px_s,
                                 int points) const;

 private:
  std::deque<Moment> moments_;
  std::deque<ForceTick> ticks_;
  double largest_speed_px_s_ = 0;
  double plotted_s_ = kPlotted_s;
};

}  // namespace spidar::window
