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

/// What a person chose to feel, by the rules of `feel` and by the mouse, and the reports when that
/// cannot be felt. Streaming thread, unless stated otherwise.
class MotionChoice {
 public:
  explicit MotionChoice(GstElement* element) : element_(element) {}

  MousePointer& mouse() { return mouse_; }
  /// Null when there are none. Any thread.
  std::shared_ptr<const FeelRules> rules() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return named_.rules;
  }

  /// Begins another stream, from the file `film` or, when that is empty, from elsewhere.
  void begin_stream(const std::string& film);

  /// Tells that the property `feel` was set. Any thread.
  void rules_changed() { is_read_ = false; }
  /// Whether read() must be called before the next frame. True once after each change.
  bool is_to_read() { return !is_read_.exchange(true); }
  /// Reads the rules that `feel` means, and reports on the bus what is wrong with them. The
  /// duration of the film is queried from the peer of `sink`.
  void read(const std::string& feel, GstPad* sink);

  /// Completes the settings of `frame` by what rules, mouse and boxes choose. `turn` turns the
  /// frame before it is shown. The pointer of `settings` is a position in the shown frame, and
  /// becomes one in the stored frame.
  void complete(const GstVideoFrame& frame, const Orientation& turn, FrameSettings& settings);

  /// Posts once what became of each rule and click.
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
  std::set<std::pair<int, Chosen::State>> told_;  ///< line and state
  GstClockTime seen_ = 0;                         ///< stream time of the previous frame
};

}  // namespace spidar::filter
