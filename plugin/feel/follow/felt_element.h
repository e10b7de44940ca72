// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Functions for the element that renders the force: spidar-feel sets its properties from the
/// command line, and prints its messages.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gst/gst.h>

namespace spidar::follow {

/// Prints a text for people. Shortens it, because its names and addresses come from other programs,
/// which may send megabytes. Any thread.
void print_message(const std::string& text);

/// Throws std::runtime_error, which says what is wrong with the line.
GstElement* parse_pipeline(const std::string& line);

/// The value of the last NAME=VALUE; null if there is none.
const char* value_of(const std::vector<std::string>& properties, const std::string& name);

/// The value of `debug-window`; nothing when the properties do not have it.
std::optional<bool> wants_window(const std::vector<std::string>& properties);

bool has_display();

/// Sets NAME=VALUE and preset=NAME. Returns the names that `felt` lacks, separated by commas. Does
/// not count debug-window, because another element then shows the window.
std::string set_properties(GstElement* felt, const std::vector<std::string>& properties);

/// The text of a message for people; empty when the message is for programs.
std::string text_for_people(GstMessage* message);

/// Whether the message says that a simulated device was opened; nothing for other messages.
std::optional<bool> parse_is_simulated(GstMessage* message);

}  // namespace spidar::follow
