// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors

// For a program with the address sanitizer: no library is unloaded. LeakSanitizer names a leak by
// its library, and the graphics driver, whose leaks are not ours (tests/leaks.supp), would
// otherwise have no name when the program ends.
extern "C" int dlclose(void*) {
  return 0;
}
