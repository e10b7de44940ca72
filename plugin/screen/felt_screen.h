// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a screen shows, felt.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "plugin/screen/view.h"

namespace spidar::screen {

/// Captures a view, analyses it and renders its force. One thread.
class FeltScreen {
 public:
  /// `properties` are those of spidarmotion, NAME=VALUE. Opens the device and begins. Without a
  /// device, the debug window shows what would be felt. Throws std::runtime_error, which says what
  /// is wrong.
  FeltScreen(View& view, const std::vector<std::string>& properties);
  ~FeltScreen();
  FeltScreen(const FeltScreen&) = delete;
  FeltScreen& operator=(const FeltScreen&) = delete;

  /// Says what has changed. To be called a few times a second. False when it has ended.
  bool check();

 private:
  bool read_messages();
  void say_what_is_seen();

  View& view_;
  GstElement* pipeline_;
  GstElement* felt_ = nullptr;  ///< owned by the pipeline
  bool is_simulated_ = false;
  std::set<std::string> said_;
  std::string seen_;  ///< what is seen, as it was said last
  std::string next_;  ///< as it would be said now
  int64_t next_since_ns_ = 0;
};

}  // namespace spidar::screen
