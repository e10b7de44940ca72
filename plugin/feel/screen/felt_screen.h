// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "plugin/feel/screen/view.h"

namespace spidar::screen {

/// Captures a view, analyses it and renders its force. One thread.
class FeltScreen {
 public:
  /// `properties` are those of spidarmotion, NAME=VALUE. Opens the device and begins. Without a
  /// device, the debug window shows the force. Throws std::runtime_error, which says what is wrong.
  FeltScreen(View& view, const std::vector<std::string>& properties);
  ~FeltScreen();
  FeltScreen(const FeltScreen&) = delete;
  FeltScreen& operator=(const FeltScreen&) = delete;

  /// Prints changes. Call this a few times a second. Returns false when the view has ended.
  bool check();

 private:
  /// A remark that is printed when it has been true for a while, and again after other remarks.
  struct Remark {
    std::string text;
    int64_t since_ns = 0;
    bool is_due = false;
  };

  bool read_messages();
  void say_what_is_seen();
  void say(Remark& last, const std::string& text);
  std::string words_for_film(const GstStructure* stats) const;

  View& view_;
  GstElement* pipeline_;
  GstElement* felt_ = nullptr;  ///< owned by the pipeline
  bool is_simulated_ = false;
  std::set<std::string> said_;  ///< printed messages
  std::string told_;            ///< the last remark
  Remark film_;                 ///< on the position of the film
  Remark reason_;               ///< on why nothing is felt
};

}  // namespace spidar::screen
