// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <sys/auxv.h>
#include <unistd.h>

namespace spidar {

/// The path of the running program's file; where there is no /proc, as in a plain chroot, the path
/// that started the program.
inline const char* own_program() noexcept {
  constexpr const char* kByKernel = "/proc/self/exe";
  const bool has_proc = access(kByKernel, F_OK) == 0;
  return has_proc ? kByKernel : reinterpret_cast<const char*>(getauxval(AT_EXECFN));
}

}  // namespace spidar
