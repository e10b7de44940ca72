// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Writes a file so that it is either whole or as it was.
#pragma once

#include <filesystem>
#include <string>

namespace spidar {

/// Writes to a new file in the same folder, which then gets the name `file`. Follows no link at its
/// own file's name, and replaces a link of the name `file`; does not replace a device or a folder.
/// Throws ProfileError with the system's reason; the old file is unchanged then.
void replace_file(const std::filesystem::path& file, const std::string& text);

}  // namespace spidar
