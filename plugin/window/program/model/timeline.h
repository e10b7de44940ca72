// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The last minute of a window, and the moment of it that is looked at.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"
#include "core/wrench.h"
#include "plugin/window/program/model/still.h"
#include "spidar/loop/tick_record.h"

namespace spidar {

/// What the grip and the plots of speed show of one moment. Times are those of CLOCK_MONOTONIC.
struct Moment {
  double time_s = 0;
  double interval_s = 0;  ///< of the frame before, when a new one has come; 0 otherwise
  double speed_px_s = 0;  ///< of the reference frame, before the filter
  Wrench wanted;          ///< by the controller, of the newest frame
  Wrench felt;            ///< delivered at the grip; zero without a device
  Wrench asked;           ///< of the device, for what was on the screen
  StringVector tension_N = StringVector::Zero();
  Pose pose;
  Contact contact;
};

/// The forces of the milliseconds in one pixel's width of a plot, and from the pixel before to it.
struct ForceColumn {
  bool is_empty = true;
  Eigen::Vector3d wanted_low_N, wanted_high_N, delivered_low_N, delivered_high_N;  ///< by axis
  double most_N = 0;  ///< the largest that was delivered, of all directions
};

/// Records moments, forces and pictures as they come, whether it is paused or not. While it is
/// paused it shows what was recorded up to then, at any time of it; resume() shows the newest
/// again, without a gap.
class Timeline {
 public:
  static constexpr double kMemory_s = 60;  ///< older moments and pictures are forgotten
  static constexpr double kPlotted_s = 5;  ///< what the plots show at first, up to the cursor
  static constexpr double kLeastPlotted_s = 0.5, kMostPlotted_s = 20;
  static constexpr double kStill_s = 0.25;  ///< between two pictures that are kept

  /// Moments in order of time.
  void add(const Moment& moment);
  /// Forces in order of time, of each millisecond where there is a device.
  void add(const ForceTick& tick);
  /// Whether a picture at this time is due, kStill_s after the last one.
  bool wants_still(double time_s) const;
  /// Pictures in order of time.
  void add_still(std::shared_ptr<const Still> still);
  /// Another stream: nothing of what was recorded concerns it. A paused view stays.
  void forget();

  bool is_paused() const { return frozen_.has_value(); }
  void pause();
  void resume() { frozen_.reset(); }
  /// Pauses, and looks at this time or the nearest one there is.
  void look_at(double time_s);

  /// The time that is looked at: the newest unless paused. 0 when there is nothing.
  double cursor_s() const;
  /// All that can be looked at, oldest first.
  const std::deque<Moment>& moments() const { return shown().moments; }
  /// What the plots show, seconds.
  double plotted_s() const { return plotted_s_; }
  /// They show `factor` times as long.
  void zoom(double factor);
  /// The last plotted_s() before the cursor, and the moment at it; a part of moments().
  struct Part {
    std::deque<Moment>::const_iterator first, last;
    auto begin() const { return first; }
    auto end() const { return last; }
    bool empty() const { return first == last; }
    const Moment& back() const { return *(last - 1); }
  };
  Part plotted() const;
  /// The lowest and highest forces in each of `count` equal parts of the time from one to another,
  /// whatever the rate at which the window draws.
  std::vector<ForceColumn> columns(double from_s, double to_s, size_t count) const;
  /// The picture at the cursor, or the oldest; null when it is live, or none was kept.
  std::shared_ptr<const Still> still() const;

  /// Largest speed since the controller began to learn, for the linear one (eq. 13).
  double largest_speed_px_s() const { return largest_speed_px_s_; }

 private:
  struct Record {
    std::deque<Moment> moments;
    std::deque<ForceTick> ticks;
    std::deque<std::shared_ptr<const Still>> stills;
  };
  struct Frozen {
    Record record;
    double cursor_s = 0;
  };
  const Record& shown() const { return frozen_ ? frozen_->record : live_; }

  Record live_;
  std::optional<Frozen> frozen_;
  double largest_speed_px_s_ = 0;
  double plotted_s_ = kPlotted_s;
};

}  // namespace spidar
