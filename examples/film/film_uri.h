// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Films named on the command line.
#pragma once

#include <string>

/// Returns `file_or_uri` as a URI. Throws std::invalid_argument, with the name and the reason, when
/// it cannot be a film: a missing file, a folder, or an empty file.
std::string film_uri(const std::string& file_or_uri);
