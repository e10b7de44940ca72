// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Files that are read, or written anew, as a whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace spidar {

/// Returns the content of a file of at most `most_bytes`. Throws std::runtime_error, which says
/// what is wrong as the end of a sentence ("it is not a regular file"), also when the system calls
/// it regular, but does not let it be read, as with /proc/self/mem.
std::string read_regular_file(const std::string& path, size_t most_bytes);

/// Notes that this program reads `file`, so that no output takes its place (expect_not_read()).
void note_read(const std::filesystem::path& file);

/// Throws std::runtime_error when `output` is a file that note_read() has noted, whatever its name:
/// a link to it, or the same file by another name.
void expect_not_read(const std::filesystem::path& output);

/// The file to write for `path`: where a link leads, so that the link stays one and leads to the
/// new file; otherwise `path`. Throws std::runtime_error for a link that leads to nothing.
std::filesystem::path place_of_output(const std::filesystem::path& path);

/// Gives the open file the permissions of the one at `path`, its access control list among them,
/// and its owner as far as this user may. Does nothing when there is none.
void keep_permissions(int file, const std::filesystem::path& path);

/// Writes to a new file in the same folder, which then gets the name `named_file` and the
/// permissions of the file that it replaces. A link of that name stays one, and the file that it
/// leads to is replaced; a device or a folder is not, and no link is followed at the new file's own
/// name. Throws std::runtime_error with the system's reason; the old file is unchanged then.
void replace_file(const std::filesystem::path& named_file, const std::string& text);

}  // namespace spidar
