// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a device says of itself, as it may be printed.
#pragma once

#include <string>
#include <string_view>

namespace spidar {

/// The text with a question mark for each control character, which a terminal would obey, for each
/// character that turns the direction of writing round, and for each byte that is not UTF-8, which
/// neither JSON nor GStreamer takes. To be used where a name, a serial number or the like comes
/// from a device.
std::string printable(std::string_view text);

}  // namespace spidar
