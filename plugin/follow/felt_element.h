// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What spidar-feel does with the element that renders the force: it sets what the command line
/// gives, and prints what the element says.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gst/gst.h>

namespace spidar::follow {

/// Prints a text for people, shortened because its names and addresses come from other programs,
/// which may send megabytes. Any thread.
void tell(const std::string& text);

/// Throws std::runtime_error, which says what is wrong with the line.
GstElement* parse_pipeline(const std::string& line);

/// The value of the last NAME=VALUE; null if there is none.
const char* value_of(const std::vector<std::string>& properties, const std::string& name);

/// Of `debug-window`: nothing when the properties do not have it.
std::optional<bool> wants_window(const std::vector<std::string>& properties);

/// Whether there is a screen for the debug window.
bool has_display();

/// Sets NAME=VALUE and preset=NAME. Returns the names that `felt` does not have, with commas, but
/// debug-window, which is shown by another element then.
std::string set_properties(GstElement* felt, const std::vector<std::string>& properties);

/// What a message says to people; empty when it is for programs.
std::string text_for_people(GstMessage* message);

/// Whether the device is a simulated one, when the message says which device was opened.
std::optional<bool> says_simulated(GstMessage* message);

}  // namespace spidar::follow
