// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Files that this program reads.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace spidar {

/// Returns the content of a file of at most `most_bytes`. Throws std::runtime_error, which says
/// what is wrong as the end of a sentence ("it is not a regular file"), also when the system calls
/// it regular, but does not let it be read, as with /proc/self/mem.
std::string read_regular_file(const std::string& path, size_t most_bytes);

/// Records that this program reads `file`, so that no output replaces it (expect_not_read()).
void note_read(const std::filesystem::path& file);

/// Throws std::runtime_error when `output` is a file that note_read() has recorded, under any name:
/// a link to it, or the same file by another name.
void expect_not_read(const std::filesystem::path& output);

}  // namespace spidar
