// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <filesystem>

namespace spidar {

/// The folder that this variable of the XDG Base Directory Specification names, or `below_home`.
/// Services and containers may have no HOME; then the user's entry in the password database counts,
/// as in a set-user-ID program, whose environment is its caller's (secure_getenv(3)). Empty for a
/// user without a home. The result is never a relative path, which would lie in any folder from
/// which a program is started.
std::filesystem::path user_folder(const char* variable, const char* below_home);

}  // namespace spidar
