// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The commands of spidarctl. Each takes its own command line, in which argv[0] is its name, and
/// returns the exit status. They throw UsageError, DeviceError and ProfileError.
#pragma once

#include "spidar/tools/exit_status.h"

namespace spidar {

int calibrate_command(int argc, char** argv);
int choose_command(int argc, char** argv);
int conformance_command(int argc, char** argv);
int info_command(int argc, char** argv);
int list_command(int argc, char** argv);
int monitor_command(int argc, char** argv);
int pull_command(int argc, char** argv);
int rest_command(int argc, char** argv);
int selftest_command(int argc, char** argv);
int zero_command(int argc, char** argv);

}  // namespace spidar
