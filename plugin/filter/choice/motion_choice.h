// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include <gst/video/video.h>

#include "core/choice/object_choice.h"
#include "core/orientation.h"
#include "plugin/filter/choice/feel_file.h"
#include "plugin/filter/choice/sink_mouse.h"
#include "plugin/properties/motion_properties.h"

namespace spidar::filter {

/// Combines what the rules of `feel` and the mouse choose to be felt, and posts a message when the
/// choice cannot be felt. Use it in the streaming thread, unless stated otherwise.
class MotionChoice {
 public:
  explicit MotionChoice(GstElement* element) : element_(element) {}

  MousePointer& mouse() { return mouse_; }
  /// Returns the current rules; null if there are none. Any thread.
  std::shared_ptr<const FeelRules> rules() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return named_.rules;
  }

  /// Begins another stream, which comes from the file `film`, or from no file if `film` is empty.
  void begin_stream(const std::string& film);

  /// Call this when the property `feel` was set. Any thread.
  void rules_changed() { is_read_ = false; }
  /// Returns true once after each change: call read() before the next frame.
  bool must_read() { return !is_read_.exchange(true); }
  /// Reads the rules that `feel` selects, and posts warnings about mistakes in them. Queries the
  /// duration of the film from the peer of `sink`.
  void read(const std::string& feel, GstPad* sink);

  /// Adds to the settings of `frame` what rules, mouse and boxes choose. `turn` is the orientation
  /// in which the frame is shown. Converts the pointer of `settings` from a position in the shown
  /// frame to one in the stored frame.
  void complete(const GstVideoFrame& frame, const Orientation& turn, FrameSettings& settings);

  /// Posts a message, once for each rule or click, when its object cannot be felt.
  void check(const Chosen& choice, const KeptObject& kept, GstClockTime stream_time);

 private:
  void warn_of_times(GstPad* sink);
  void warn_of_mean(MotionKind motion);
  void warn_of_rule(const FeelRule& rule, Chosen::State state);
  std::string seen_text() const;
  void warn_of_click(const KeptObject& kept, Chosen::State state);

  GstElement* const element_;
  MousePointer mouse_;
  std::string film_;
  std::atomic<bool> is_read_{false};
  mutable std::mutex mutex_;  ///< guards changes of `named_`, and its use in other threads
  NamedRules named_;
  bool warned_of_mean_ = false;
  std::set<std::pair<int, Chosen::State>> posted_;  ///< line of the rule, posted state
  GstClockTime seen_ = 0;                           ///< stream time of the previous frame
};

}  // namespace spidar::filter
