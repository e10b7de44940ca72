// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <X11/Xlib.h>
#include <string>
#include <vector>

namespace spidar::screen {

/// The class of this project's windows, which nobody wants to feel.
constexpr const char* kOwnClass = "spidar-window";

/// From now on, a call that fails because a window is gone has no consequence; otherwise Xlib ends
/// the process, as it still does when the server ends, and the guardian sets the motors to zero.
/// For all connections of the process.
void handle_x11_errors();

/// Whether a call that this thread waited for has failed since the last query.
bool take_x11_failure();

std::string title_of(Display* display, Window window);

bool is_own(Display* display, Window window);

/// Windows of programs, the uppermost last; also minimised ones where a window manager lists them.
std::vector<Window> program_windows(Display* display);

/// The window of the program within `frame`, which a window manager may have put around it.
Window program_window_in(Display* display, Window frame);

/// Waits for a click of the left button. Returns the root window for a click beside all windows,
/// and 0 when another button was pressed, or another program has the mouse.
Window clicked_window(Display* display);

}  // namespace spidar::screen
