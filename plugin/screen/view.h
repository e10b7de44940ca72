// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is looked at: a screen, or a window on it.
#pragma once

#include <memory>
#include <string>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"

namespace spidar::screen {

/// One thread, but for the pictures that its source makes.
class View {
 public:
  virtual ~View() = default;
  /// For people: `the window "Film"`.
  virtual std::string name() const = 0;
  /// A new element, whose pictures are live.
  virtual Ref<GstElement> make_source() = 0;
  /// What has become of it since the last call, in a sentence; empty: nothing. Called a few times
  /// a second.
  virtual std::string change() = 0;
  /// Whether pictures of it come; until they do, they say nothing of a film.
  virtual bool is_shown() const { return true; }
  /// Whether no further picture of it comes.
  virtual bool has_ended() const = 0;
};

/// `what`: the title of a window or a part of it, "ask" for a click on a window, or empty for the
/// whole screen. Waits for that click. Throws std::runtime_error, which says what is wrong and what
/// helps.
std::unique_ptr<View> view_of_x11(const std::string& what);

/// A program of X11 or Wayland as the desktop lets the user choose it: `is_asked` again, or as last
/// time. Throws like view_of_x11().
std::unique_ptr<View> view_of_portal(bool is_asked);

}  // namespace spidar::screen
