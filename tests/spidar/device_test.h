// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Devices and sessions that a test drives itself.
#pragma once

#include "spidar/device_error.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/support/messages.h"

namespace spidar::test {

/// Guarded by nobody. Not `threaded`, it exchanges on the thread of the test.
inline boards::Settings unguarded(bool threaded = false) {
  boards::Settings settings;
  settings.guardian = false;
  settings.threaded = threaded;
  return settings;
}

/// The test makes the ticks.
inline SessionSettings by_hand() {
  SessionSettings settings;
  settings.threaded = false;
  return settings;
}

/// The message of open(); empty on success.
template <typename Opened>
std::string opening(Opened& device) {
  return message_of<DeviceError>([&] { device.open(); });
}

}  // namespace spidar::test
