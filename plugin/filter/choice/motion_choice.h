// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a person chose to feel, and what is reported when that cannot be.
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

/// The rules of `feel`, and the mouse. Streaming thread, unless another is named.
class MotionChoice {
 public:
  explicit MotionChoice(GstElement* element) : element_(element) {}

  /// Any thread.
  MousePointer& mouse() { return mouse_; }
  /// Null when there are none. Any thread.
  std::shared_ptr<const FeelRules> rules() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return named_.rules;
  }

  /// Another stream, from the file `film` or, when that is empty, from elsewhere.
  void begin_stream(const std::string& film);

  /// The property `feel` was set. Any thread.
  void rules_changed() { is_read_ = false; }
  /// Whether read() has to come before the next frame.
  bool is_to_read() { return !is_read_.exchange(true); }
  /// Reads what `feel` means, and reports on the bus what is wrong with it. `sink` is asked for the
  /// duration of the film.
  void read(const std::string& feel, GstPad* sink);

  /// Completes the settings of `frame` by what rules, mouse and boxes choose. `turn` turns the
  /// frame before it is shown; the pointer of `settings` is a position of it as it is shown, and
  /// becomes one before.
  void complete(const GstVideoFrame& frame, const Orientation& turn, FrameSettings& settings);

  /// Says on the bus what became of each rule and click, once.
  void check(const Chosen& choice, const KeptObject& kept, GstClockTime stream_time);

 private:
  void warn_of_times(GstPad* sink);
  void warn_of_mean(MotionKind motion);
  void tell_of_rule(const FeelRule& rule, Chosen::State state);
  /// The time in the film of the frame before.
  std::string seen_text() const;
  void tell_of_click(const KeptObject& kept, Chosen::State state);

  GstElement* const element_;
  MousePointer mouse_;
  std::string film_;
  std::atomic<bool> is_read_{false};
  mutable std::mutex mutex_;  ///< where another thread reads `named_`, or it changes
  NamedRules named_;
  bool warned_of_mean_ = false;
  std::set<std::pair<int, Chosen::State>> told_;  ///< line and state
  GstClockTime seen_ = 0;                         ///< stream time of the frame before
};

}  // namespace spidar::filter
