// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which command has written a file, and whether it is still as it was then.
#pragma once

#include <string>

namespace spidar {

/// Notes in an extended attribute of the open file, whose content is complete, that `maker` has
/// written it, with its size and the time of its last change. Where the file system keeps no
/// attributes (FAT, NFS before 4.2), nothing is noted.
void mark_written(int file, const std::string& maker);

/// Whether `maker` has written the file at `path`, and nobody has changed its content since.
bool is_as_written(const std::string& path, const std::string& maker);

}  // namespace spidar
