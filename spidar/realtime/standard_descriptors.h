// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// For the beginning of main().
#pragma once

#include <fcntl.h>
#include <unistd.h>

namespace spidar {

/// Opens /dev/null for each of the descriptors 0 to 2 that is closed, as after `>&-` in a shell.
/// Otherwise the next file that the program opens gets that number, and what is printed, or what a
/// library writes to the standard error, goes into the file. To be called before anything is
/// opened.
inline void open_standard_descriptors() {
  int lowest_free = 0;
  do {
    lowest_free = open("/dev/null", O_RDWR);
  } while (lowest_free >= 0 && lowest_free <= STDERR_FILENO);
  if (lowest_free > STDERR_FILENO) close(lowest_free);
}

}  // namespace spidar
