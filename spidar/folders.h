// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where programs and their files are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace spidar {

/// The path of the running program's file; where there is no /proc, as in a plain chroot, the path
/// that started the program.
const char* own_program() noexcept;

/// Returns the file from which this code was loaded, a program or a library; empty if unknown.
std::filesystem::path own_file();

/// Returns the prefix below which `file` is installed, if `file` lies in the prefix's folder for
/// libraries, GStreamer plugins or programs; empty for a file elsewhere, as in a build folder.
std::filesystem::path prefix_of(const std::filesystem::path& file);

/// Returns the path `below` under the prefix of this code or, if this code is not installed, under
/// the prefix of the build. An absolute `below` is returned as it is.
std::filesystem::path installed(const std::string& below);

/// Returns the folders that the environment variable `name` lists, separated by colons. A colon in
/// the name of an existing folder separates nothing: "/films/Ring: the first".
std::vector<std::filesystem::path> listed_folders(const char* name);

/// The folder that this variable of the XDG Base Directory Specification names, or `below_home`.
/// Services and containers may have no HOME; then the user's entry in the password database counts,
/// as in a set-user-ID program, whose environment is its caller's (secure_getenv(3)). Empty for a
/// user without a home. The result is never a relative path, which would lie in any folder from
/// which a program is started.
std::filesystem::path user_folder(const char* variable, const char* below_home);

}  // namespace spidar
