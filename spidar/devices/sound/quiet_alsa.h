// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Errors of ALSA's library.
#pragma once

#include <alsa/asoundlib.h>
#include <cstdarg>

namespace spidar {

/// snd_lib_error_set_local(), for which ALSA's header lacks extern "C".
extern "C" snd_local_error_handler_t set_alsa_error_handler(
    snd_local_error_handler_t handler) __asm__("snd_lib_error_set_local");

/// During the lifetime of this object, ALSA's library does not print errors of this thread on the
/// standard error: the DeviceError reports them. A handler that the program has set stays.
class QuietAlsa {
 public:
  QuietAlsa() noexcept : before_(set_alsa_error_handler(ignore)) {}
  ~QuietAlsa() { set_alsa_error_handler(before_); }
  QuietAlsa(const QuietAlsa&) = delete;
  QuietAlsa& operator=(const QuietAlsa&) = delete;

 private:
  static void ignore(const char*, int, const char*, int, const char*, va_list) {}

  const snd_local_error_handler_t before_;
};

}  // namespace spidar
