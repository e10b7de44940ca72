// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Writes profile files.
#pragma once

#include <string>

#include "spidar/profiles/profile.h"

namespace spidar {

/// TOML from which load_profile() reads exactly the same profile, except for its name, which is
/// that of the file. Geometry is in D and metres.
std::string profile_text(const Profile& profile);

/// Writes profile_text() to `path` atomically: an existing file is replaced when the new one is
/// complete. Throws ProfileError.
void save_profile(const Profile& profile, const std::string& path);

}  // namespace spidar
