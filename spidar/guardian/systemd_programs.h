// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Programs of systemd, which work only where it is running.
#pragma once

#include <cstdlib>
#include <string>
#include <unistd.h>

namespace spidar {

/// The path of a program of systemd; empty when systemd is not running. $SPIDAR_SYSTEMD names
/// another folder for these programs; if it is empty, none is used.
inline std::string systemd_program(const char* name) {
  const char* folder = std::getenv("SPIDAR_SYSTEMD");
  // The check that sd_booted(3) documents.
  if (!folder) folder = access("/run/systemd/system", F_OK) == 0 ? "/usr/bin" : "";
  return *folder ? std::string(folder) + "/" + name : std::string();
}

}  // namespace spidar
