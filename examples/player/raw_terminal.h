// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A terminal that gives each key at once.
#pragma once

/// Each key at once and unseen while this lives, where `file` is a terminal. The terminal is as
/// before when it is destroyed, when a signal ends the process and while one stops it (Ctrl-Z).
/// One at a time.
class RawTerminal {
 public:
  explicit RawTerminal(int file);
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;
};
