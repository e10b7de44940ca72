// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Files that this program reads.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace spidar {

/// Returns the content of a file of at most `most_bytes`. Throws std::runtime_error with the end of
/// a sentence ("it is not a regular file"), also for a file that is regular but cannot be read,
/// such as /proc/self/mem.
std::string read_regular_file(const std::string& path, size_t most_bytes);

/// Records that this program reads `file`, so that no output replaces it (expect_not_read()).
void note_read(const std::filesystem::path& file);

/// Throws std::runtime_error when `output` is a file that note_read() has recorded, also if it is a
/// link to that file or another name of it.
void expect_not_read(const std::filesystem::path& output);

}  // namespace spidar
