// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Keys of a terminal.
#pragma once

#include <string>
#include <termios.h>

/// Each key at once and unseen while this lives, where `file` is a terminal.
class RawTerminal {
 public:
  explicit RawTerminal(int file);
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

 private:
  int file_;
  termios before_{};  // before changed_, with which it is filled in
  bool changed_;
};

enum class Command { kNone, kPause, kSeek, kSpeed, kLoop, kStep, kForce, kDelay, kQuit };

struct Action {
  Command command = Command::kNone;
  int value = 0;  ///< kSeek: seconds; kSpeed: +1 or −1; kDelay: ms
};

/// Puts keys together that come as several bytes: arrows, and d with a number.
class KeyReader {
 public:
  /// What the next byte completes.
  Action take(char byte);

  /// The number that is being typed, with its d; empty otherwise.
  const std::string& typed() const { return typed_; }

 private:
  std::string escape_;
  std::string typed_;
};
