// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The person in front of it: signals, questions, files.
#pragma once

#include <string>

#include "spidar/wiring/string_hold.h"

namespace spidar {

/// From now on SIGINT, SIGTERM and SIGHUP only set interrupted(): the strings are released before
/// the program ends, whoever ends it.
void catch_signals();
bool interrupted();

/// A millisecond after the last call, or at once when that is past; false when interrupted.
Pace every_millisecond();

/// True when the answer is yes. Throws UsageError when there is nobody to ask.
bool confirm(const std::string& question);

/// Before anything moves for nothing. Throws ProfileError.
void check_folder_of(const std::string& file);

}  // namespace spidar
