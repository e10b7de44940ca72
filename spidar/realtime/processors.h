// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How much there is to compute with.
#pragma once

#include <filesystem>

namespace spidar {

/// The processors that this process may run on, or as many as it has the time of: a container or a
/// batch system may limit that by a control group (cpu.max, or cpu.cfs_quota_us of version 1; the
/// kernel's cgroup-v2.rst and sched-bwc.rst). At least 1. `root` is another folder in tests only.
unsigned usable_processors(const std::filesystem::path& root = "/");

}  // namespace spidar
