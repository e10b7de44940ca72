// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Interaction with the person at the terminal: signals, questions, files.
#pragma once

#include <string>

#include "spidar/conformance/string_hold.h"

namespace spidar {

/// From now on SIGINT, SIGTERM and SIGHUP only set interrupted(), so that the strings are released
/// before the program ends.
void catch_signals();
bool interrupted();

/// Waits until a millisecond after the last call, or not at all if that has passed; returns false
/// when interrupted.
Pace every_millisecond();

/// Returns true when the answer is yes. Throws UsageError when standard input is not a terminal.
bool confirm(const std::string& question);

/// Checks that the file can be written, before the device moves in vain. Throws ProfileError.
void check_folder_of(const std::string& file);

}  // namespace spidar
