// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Decodes keys of a terminal.
#pragma once

#include <string>

enum class Command { kNone, kPause, kSeek, kSpeed, kLoop, kStep, kForce, kDelay, kQuit };

struct Action {
  Command command = Command::kNone;
  int value = 0;  ///< kSeek: seconds; kSpeed: +1 or −1; kDelay: ms
};

/// Decodes keys that arrive as several bytes: arrows, and d with a number.
class KeyReader {
 public:
  /// Takes the next byte and returns the key that it completes.
  Action take(char byte);

  /// The d and number typed so far; empty otherwise.
  const std::string& typed() const { return typed_; }

 private:
  std::string escape_;
  std::string typed_;
};
