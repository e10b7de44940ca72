// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How many processors this process may use, which may be fewer than the machine has.
#pragma once

#include <string>

namespace spidar {

/// What taskset, a batch system or a container leaves of the processors, at least 1: those that
/// the process is bound to (sched_getaffinity(2)), and not more than the quota of its control
/// group.
unsigned usable_processors();

/// The quota of the process, in processors, or a number that no machine has. `groups` has the lines
/// of /proc/self/cgroup, and `mounted` is where control groups are mounted, of version 2 or 1
/// (Documentation/admin-guide/cgroup-v2.rst of the kernel, `cpu.max`).
double processor_quota(const std::string& groups, const std::string& mounted);

}  // namespace spidar
