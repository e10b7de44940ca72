// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A terminal that delivers each key at once.
#pragma once

/// While this object lives, keys on the terminal `file` are delivered at once and not echoed. The
/// terminal is restored when the object is destroyed, when a signal ends the process, and while one
/// stops it (Ctrl-Z). Only one such object may exist at a time.
class RawTerminal {
 public:
  explicit RawTerminal(int file);
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;
};
