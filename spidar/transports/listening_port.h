// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Whether a service of this computer runs.
#pragma once

#include <cstdint>

namespace spidar {

/// Whether a program listens at this TCP port, on the loopback or on all addresses. Reads the
/// kernel's list, and connects to nothing. False where that cannot be read.
bool is_listening(uint16_t port);

}  // namespace spidar
