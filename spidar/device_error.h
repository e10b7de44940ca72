// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How opening a device fails, and how an exchange with it ends.
#pragma once

#include <stdexcept>

namespace spidar {

/// A device that cannot be opened. what() says which, why, and what to do.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class ExchangeStatus {
  kOk,
  kTimeout,   ///< no answer in time; may come back
  kBadReply,  ///< short, garbled or mismatched answer; may come back
  kLost,      ///< unplugged or closed: open() again
};

}  // namespace spidar
