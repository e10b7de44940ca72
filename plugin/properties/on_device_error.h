// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What happens when the device fails while playing.
#pragma once

namespace spidar {

enum class OnDeviceError { kWarn, kError };

}  // namespace spidar
