// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What Profile::board may be: the controller that a SPIDAR was used with.
#pragma once

#include <initializer_list>
#include <string_view>

namespace spidar::board_name {

constexpr const char* kSh4 = "usb-sh4";
constexpr const char* kSimple = "usb-simple";
constexpr const char* kUart = "uart";
constexpr const char* kAhs = "ahs";          ///< has no driver
constexpr const char* kUnknown = "unknown";  ///< its source names none; may be any

inline const std::initializer_list<std::string_view> kAll = {kSh4, kSimple, kUart, kAhs, kUnknown};

}  // namespace spidar::board_name
