// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How much of the analysis is done so that it keeps to a budget of time.
#pragma once

#include <cstdint>

namespace spidar {

/// Chooses from what the frames so far have cost how much is left out of the next one, so that 99 %
/// of the frames keep to the budget. Knows no clock: the same costs give the same rungs.
///
/// Rung 0 is all of the analysis. Rung 1 follows no points, and from rung 2 on the picture in which
/// the blocks are measured is a step smaller each time, see field_scale().
///
/// What a film costs is not known at first, so it begins on the lowest rung. It climbs when even
/// the dearest of the last frames leaves room for what the higher rung costs at most (kDearer).
/// Each frame saves a hundredth of a frame that may be above the budget; with a whole one saved, it
/// also tries whether the next rung is cheaper here than that. A frame above the budget is paid
/// from what is saved, or else makes it descend, and so does each one soon after a climb. After a
/// climb that failed it waits twice as long as before.
class WorkLadder {
 public:
  static constexpr int kLowest = 4;

  /// In ns of processor time a frame; 0 or less: no limit, and rung 0. A change keeps the rung,
  /// unless there was no limit before.
  void set_budget_ns(int64_t budget_ns);
  int64_t budget_ns() const { return budget_ns_; }

  /// Of the next frame: 0 … kLowest.
  int rung() const { return rung_; }

  /// What a frame on rung() has cost. One that was not compared with another picture
  /// (`is_compared` is false) costs little and tells nothing of the others. Returns whether it was
  /// above the budget.
  bool add(int64_t cost_ns, bool is_compared);

 private:
  void descend(int64_t cost_ns);
  void look_up();
  void stand_on(int rung);

  int64_t budget_ns_ = 0;
  int rung_ = 0;
  double saved_ = 0;        ///< frames that may be above the budget, 0 … 1
  int compared_ = 0;        ///< frames since it looked up
  int64_t dearest_ns_ = 0;  ///< of these
  /// After how many frames it looks up, and how many after a try it tries again.
  int wait_ = 0;
  int wait_to_try_ = 0;
  int since_try_ = 0;
  int since_climb_ = 0;     ///< up to kOnTrial: as if it had never climbed
  bool has_tried_ = false;  ///< the last climb was a try
};

}  // namespace spidar
