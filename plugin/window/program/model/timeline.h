// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The last minute of a window.
#pragma once

#include <cmath>
#include <deque>
#include <vector>

#include "core/wrench.h"
#include "plugin/window/view/window_view.h"
#include "spidar/loop/tick_record.h"

namespace spidar::window {

/// Whether two forces are one number to a reader, who sees a decimal.
inline bool are_same(const Wrench& wanted, const Wrench& delivered) {
  constexpr double kShown_per_N = 10;
  return std::lround(kShown_per_N * wanted.force_N.norm()) ==
         std::lround(kShown_per_N * delivered.force_N.norm());
}

/// The values of one moment that the plots of speed show. Times are those of CLOCK_MONOTONIC.
struct Moment {
  double time_s = 0;
  double interval_s = 0;  ///< since the previous frame, when a new one has come; 0 otherwise
  double speed_px_s = 0;  ///< of the reference frame, before the filter
  Wrench wanted;          ///< by the controller, of the newest frame
  Wrench felt;            ///< delivered at the grip; zero without a device
};

/// The forces of the milliseconds in one pixel's width of a plot, and from the pixel before to it.
struct ForceColumn {
  bool is_empty = true;
  Eigen::Vector3d wanted_low_N, wanted_high_N, delivered_low_N, delivered_high_N;  ///< by axis
  double most_N = 0;  ///< magnitude of the largest force that was delivered
};

/// Records moments and forces as they come.
class Timeline {
 public:
  static constexpr double kMemory_s = 60;  ///< older moments are forgotten
  static constexpr double kPlotted_s = 5;  ///< what the plots show at first, up to the newest
  static constexpr double kMinPlotted_s = 0.5, kMaxPlotted_s = 20;

  /// Moments in order of time.
  void add(const Moment& moment);
  /// Forces in order of time, of each millisecond where there is a device.
  void add(const ForceTick& tick);
  /// Another stream: nothing of what was recorded concerns it.
  void clear();

  /// The time of the newest moment. 0 when there is none.
  double newest_s() const { return moments_.empty() ? 0 : moments_.back().time_s; }
  /// Oldest first.
  const std::deque<Moment>& moments() const { return moments_; }
  /// Seconds that an axis from the oldest moment on has to show: at least what the plots show, and
  /// the whole memory once most of it is full. One of few round numbers, so that the axis seldom
  /// changes.
  double remembered_s() const;
  /// The time that the plots show, in seconds.
  double plotted_s() const { return plotted_s_; }
  /// Multiplies plotted_s() by `factor`, within its limits.
  void zoom(double factor);
  /// The moments of the last plotted_s(), oldest first.
  std::vector<Moment> plotted() const;
  /// The lowest and highest forces in each of `count` equal parts of the time from one to another,
  /// whatever the rate at which the window draws.
  std::vector<ForceColumn> columns(double from_s, double to_s, size_t count) const;
  /// Force in N at `points` speeds from 0 to `highest_px_s`, of a controller that has learnt from
  /// what was recorded: the linear one the largest speed since the stream began (eq. 13), the
  /// adaptive one what the plots show. Empty when the settings are out of range.
  std::vector<double> gain_curve(const ControllerSettings& settings, double highest_px_s,
                                 int points) const;

 private:
  std::deque<Moment> moments_;
  std::deque<ForceTick> ticks_;
  double largest_speed_px_s_ = 0;
  double plotted_s_ = kPlotted_s;
};

}  // namespace spidar::window
