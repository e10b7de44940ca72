// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A pipeline in real time, with the simulated device and all of its threads, on which any
/// operation may be performed.
#pragma once

#include <atomic>
#include <string>

#include <gst/gst.h>

#include "plugin/filter/motion_state.h"
#include "spidar/devices/sim/simulated_device.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tick_watch.h"

namespace spidar::test {

/// Sent by the source instead of its next frame, or with it.
enum class Upstream {
  kNothing,
  kGap,           ///< a gap event of 20 ms before the frame
  kGapFrame,      ///< the frame is marked as one
  kDiscont,       ///< the frame is marked as one
  kNoTimestamp,   ///< its timestamp is missing,
  kSameAsBefore,  ///< that of the frame before,
  kEarlier,       ///< or 100 ms before that
  kEnd,           ///< the stream ends,
  kError,         ///< or it does so with an error
};

/// The element is watched by its haptic trace, which is read whenever the player is at NULL.
class TormentedPlayer {
 public:
  TormentedPlayer();
  ~TormentedPlayer();

  GstElement* pipeline() const { return pipeline_; }
  /// "source", "size" or "sink"; the caller must unref it.
  GstElement* part(const char* name) const { return gst_bin_get_by_name(GST_BIN(pipeline_), name); }
  GstElement* element() const { return element_; }
  filter::MotionState& state() const;
  /// Null while there is none. Not while another thread changes the state.
  SimulatedDevice* device() const;

  /// Goes to NULL, and checks every tick since the last time.
  void stop();
  void set_state(GstState state);
  /// For a short time: a stream in trouble may never get there.
  bool reaches(GstState state) const;
  bool reaches_end_of_segment();
  /// The operation may be refused.
  void seek(double rate, int flags, GstClockTime start, GstClockTime stop);
  void set_caps(const std::string& caps);
  void disturb(Upstream what) { upstream_ = what; }

  /// Fails unless it is a known fault or a state that the player has entered itself.
  void drain_bus();

  const TickWatch& watch() const { return watch_; }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  GstPadProbeReturn pass(GstPad* from, GstPadProbeInfo* info);
  void check(GstMessage* error);

  TemporaryFolder folder_;
  GstElement* pipeline_;
  GstElement* element_;
  GstElement* size_;
  GstBus* bus_;
  std::atomic<Upstream> upstream_{Upstream::kNothing};
  std::atomic<int> errors_{0};  ///< on the bus since a state was refused
  GstClockTime last_pts_ = 0;   // streaming thread
  TickWatch watch_;
};

}  // namespace spidar::test
