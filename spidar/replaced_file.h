// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A new file in the place of one that exists: where it goes, and what of the old one it keeps.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace spidar {

/// The file itself where `path` is a link: the link stays one, and leads to the new file. Throws
/// std::runtime_error for a link that leads to nothing.
inline std::filesystem::path place_of_output(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path place = std::filesystem::canonical(path, error);
  if (!error) return place;
  throw std::runtime_error(path.string() + ": cannot be written: it is a link to " +
                           std::filesystem::read_symlink(path, error).string() +
                           ", which is not there; remove the link");
}

/// Gives the open file the permissions of the one at `path`, its access control list among them,
/// and its owner as far as this user may. Does nothing when there is none.
inline void keep_permissions(int file, const std::filesystem::path& path) {
  struct stat before {};
  if (stat(path.c_str(), &before) != 0) return;
  // The mode comes last: a new owner takes bits away, and a group that may not be given gets none.
  const bool has_group = fchown(file, static_cast<uid_t>(-1), before.st_gid) == 0;
  [[maybe_unused]] const int owner = fchown(file, before.st_uid, static_cast<gid_t>(-1));
  fchmod(file, before.st_mode & (has_group ? 0777U : 0707U));
  constexpr const char* kAcl = "system.posix_acl_access";
  const ssize_t bytes = getxattr(path.c_str(), kAcl, nullptr, 0);
  if (bytes <= 0) return;
  std::vector<char> acl(static_cast<size_t>(bytes));
  if (getxattr(path.c_str(), kAcl, acl.data(), acl.size()) == bytes)
    fsetxattr(file, kAcl, acl.data(), acl.size(), 0);
}

}  // namespace spidar
