// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/written_mark.h"

#include <sys/stat.h>
#include <sys/xattr.h>

namespace spidar {
namespace {

constexpr const char* kAttribute = "user.gst-spidar.written";

std::string mark_of(const struct stat& file, const std::string& maker) {
  return maker + " " + std::to_string(file.st_size) + " " + std::to_string(file.st_mtim.tv_sec) +
         " " + std::to_string(file.st_mtim.tv_nsec);
}

}  // namespace

void mark_written(int file, const std::string& maker) {
  struct stat now {};
  if (fstat(file, &now) != 0) return;
  const std::string mark = mark_of(now, maker);
  fsetxattr(file, kAttribute, mark.data(), mark.size(), 0);
}

bool is_as_written(const std::string& path, const std::string& maker) {
  struct stat now {};
  if (stat(path.c_str(), &now) != 0) return false;
  const std::string mark = mark_of(now, maker);
  std::string found(mark.size() + 1, '\0');  // longer: another one
  const ssize_t bytes = getxattr(path.c_str(), kAttribute, found.data(), found.size());
  return bytes == static_cast<ssize_t>(mark.size()) && found.compare(0, mark.size(), mark) == 0;
}

}  // namespace spidar
