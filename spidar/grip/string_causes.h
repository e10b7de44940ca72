// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

namespace spidar {

/// The causes of string faults, most likely first, worded to end a sentence.
constexpr const char* kStringCauses =
    "the motors have no supply (the emergency stop is pressed, or a supply is off); a string is "
    "slack or off its pulley; the grip was not at the centre when the device was opened; the "
    "profile is that of another device; a string is broken, or an encoder is dead";

}  // namespace spidar
