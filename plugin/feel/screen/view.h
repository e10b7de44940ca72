// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <memory>
#include <string>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"

namespace spidar::screen {

/// A screen, or a window on it. One thread, except for the pictures that its source makes.
class View {
 public:
  virtual ~View() = default;
  /// For people: `the window "Film"`.
  virtual std::string name() const = 0;
  /// A new element, whose pictures are live.
  virtual Ref<GstElement> make_source() = 0;
  /// What has changed since the last call, a sentence; empty: nothing. Called a few times a second.
  virtual std::string change() = 0;
  /// Whether pictures come; until then, nothing is known about a film.
  virtual bool is_shown() const { return true; }
  /// Whether no further picture comes.
  virtual bool has_ended() const = 0;
};

/// `what` is the title of a window or a part of the title, "ask" for a click on a window, or empty
/// for the whole screen. Waits for that click. Throws std::runtime_error with advice.
std::unique_ptr<View> view_of_x11(const std::string& what);

/// A screen or window that the user chooses in a dialog of the desktop (X11 or Wayland): a new
/// choice if `is_asked`, otherwise the last one. Throws like view_of_x11().
std::unique_ptr<View> view_of_portal(bool is_asked);

}  // namespace spidar::screen
