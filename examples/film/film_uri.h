// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a user names on the command line.
#pragma once

#include <string>

/// `file_or_uri` as a URI. Throws std::invalid_argument, with the name and the reason, for what can
/// be no film: a file that is not there, a folder, an empty file.
std::string film_uri(const std::string& file_or_uri);
