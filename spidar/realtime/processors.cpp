// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/realtime/processors.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sched.h>
#include <string>

namespace spidar {
namespace {

namespace fs = std::filesystem;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

double quota_in(const fs::path& quota_file, const fs::path& period_file) {
  std::ifstream text(quota_file), next(period_file);
  double quota_us = 0, period_us = 0;
  text >> quota_us;
  (next.is_open() ? next : text) >> period_us;
  // The files say "max" or −1 for no limit.
  return quota_us > 0 && period_us > 0 ? quota_us / period_us : kUnlimited;
}

/// Returns the smallest quota of the group and those around it. In a container, /proc may name the
/// group by a path of the host, below which nothing is mounted; then the mounted root is the
/// container's own group.
double least_quota(const fs::path& mounted, fs::path group) {
  double least = kUnlimited;
  for (bool is_root = false; !is_root; group = group.parent_path()) {
    is_root = group == group.parent_path();
    const fs::path folder = mounted / group.relative_path();
    least = std::min({least, quota_in(folder / "cpu.max", {}),
                      quota_in(folder / "cpu.cfs_quota_us", folder / "cpu.cfs_period_us")});
  }
  return least;
}

/// Returns the quota in processors.
double quota(const fs::path& root) {
  std::ifstream groups(root / "proc/self/cgroup");
  double least = kUnlimited;
  for (std::string line; std::getline(groups, line);) {  // NUMBER:CONTROLLERS:PATH
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool has_cpu = ("," + controllers + ",").find(",cpu,") != std::string::npos;
    if (!controllers.empty() && !has_cpu) continue;
    const fs::path group = line.substr(second + 1);
    if (group.is_absolute()) {
      least = std::min(least, least_quota(root / "sys/fs/cgroup" / controllers, group));
    }
  }
  return least;
}

}  // namespace

unsigned usable_processors(const fs::path& root) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  // A machine with more processors than the set holds has enough.
  const bool is_known = sched_getaffinity(0, sizeof allowed, &allowed) == 0;
  const int processors = is_known ? CPU_COUNT(&allowed) : CPU_SETSIZE;
  return static_cast<unsigned>(std::clamp<double>(quota(root), 1, processors));
}

}  // namespace spidar
