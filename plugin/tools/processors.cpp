// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/processors.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sched.h>
#include <sstream>

namespace spidar {
namespace {

constexpr double kNoQuota = std::numeric_limits<double>::infinity();

/// Of one group: version 2 has "QUOTA PERIOD" in a file, where QUOTA may be "max", version 1 a file
/// for each, where −1 is none. Both are in µs.
double quota_of(const std::filesystem::path& group) {
  double quota = 0, period = 0;
  if (std::ifstream(group / "cpu.max") >> quota >> period && period > 0) return quota / period;
  std::ifstream(group / "cpu.cfs_quota_us") >> quota;
  std::ifstream(group / "cpu.cfs_period_us") >> period;
  return quota > 0 && period > 0 ? quota / period : kNoQuota;
}

/// The lowest of a group and of those that it is in. A container may see the path of its group on
/// the host, where there is nothing: then that of the mount itself counts.
double lowest_quota(const std::filesystem::path& mounted, std::filesystem::path path) {
  double lowest = quota_of(mounted);
  for (path = path.relative_path(); !path.empty(); path = path.parent_path()) {
    lowest = std::min(lowest, quota_of(mounted / path));
  }
  return lowest;
}

}  // namespace

double processor_quota(const std::string& groups, const std::string& mounted) {
  const std::filesystem::path root = mounted;
  double lowest = kNoQuota;
  std::istringstream lines(groups);
  for (std::string line; std::getline(lines, line);) {
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string path = line.substr(second + 1);
    if (controllers == ",,") lowest = std::min(lowest, lowest_quota(root, path));
    if (controllers.find(",cpu,") != std::string::npos) {
      lowest = std::min(lowest, lowest_quota(root / "cpu", path));
    }
  }
  return lowest;
}

unsigned usable_processors() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  // A machine with more processors than the set holds has enough.
  const int bound =
      sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : CPU_SETSIZE;
  std::ifstream file("/proc/self/cgroup");
  const std::string groups{std::istreambuf_iterator<char>(file), {}};
  const double quota = std::ceil(processor_quota(groups, "/sys/fs/cgroup"));
  return static_cast<unsigned>(std::clamp(quota, 1.0, static_cast<double>(bound)));
}

}  // namespace spidar
