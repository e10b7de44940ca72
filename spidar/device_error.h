// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Why a device cannot be opened, and the line of the source that reports it.
#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>

namespace spidar {

/// A line of the source. As a default argument, `SourceLocation::here()` is the line of the call.
struct SourceLocation {
  const char* file;
  const char* function;
  int line;

  static constexpr SourceLocation here(const char* file = __builtin_FILE(),
                                       const char* function = __builtin_FUNCTION(),
                                       int line = __builtin_LINE()) {
    return {file, function, line};
  }
};

/// The reason, for programs; what() is for people.
enum class DeviceErrorCode {
  kFailed,     ///< the device is there, but does not work as it should
  kAbsent,     ///< the device is not plugged in, or the program that provides it does not run
  kBusy,       ///< another program uses the device
  kForbidden,  ///< this user may not open the device
  kSettings,   ///< the name, the profile or the configuration is wrong
};

/// Returns the code for `error`, an errno.
inline DeviceErrorCode error_code_of(int error) noexcept {
  switch (error) {
    case EACCES:
    case EPERM:
      return DeviceErrorCode::kForbidden;
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return DeviceErrorCode::kAbsent;
    case EBUSY:
    case EWOULDBLOCK:
      return DeviceErrorCode::kBusy;
    case ENOTTY:  // the file does not belong to such a device
      return DeviceErrorCode::kSettings;
    default:
      return DeviceErrorCode::kFailed;
  }
}

/// Thrown when a device cannot be opened. what() says which one, why, and what to do.
class DeviceError : public std::runtime_error {
 public:
  explicit DeviceError(const std::string& what, DeviceErrorCode code = DeviceErrorCode::kFailed,
                       SourceLocation location = SourceLocation::here())
      : std::runtime_error(what), code_(code), location_(location) {}
  DeviceErrorCode code() const noexcept { return code_; }
  const SourceLocation& location() const noexcept { return location_; }

 private:
  DeviceErrorCode code_;
  SourceLocation location_;
};

}  // namespace spidar
