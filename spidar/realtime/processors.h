// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <filesystem>

namespace spidar {

/// Returns the number of processors that this process may use, at least 1. A container or a batch
/// system may limit the processors themselves, or the time on them by a control group (cpu.max, or
/// cpu.cfs_quota_us of version 1; the kernel's cgroup-v2.rst and sched-bwc.rst). `root` is for
/// tests.
unsigned usable_processors(const std::filesystem::path& root = "/");

}  // namespace spidar
