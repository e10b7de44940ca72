// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A picture that gnuplot draws.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <sys/types.h>

namespace spidar {

/// A running gnuplot. It draws into an open file, because it runs a file name that begins with | or
/// < as a command.
class Gnuplot {
 public:
  /// Its standard output is the descriptor `out`. Throws std::runtime_error when it cannot be
  /// started.
  explicit Gnuplot(int out);
  ~Gnuplot();
  Gnuplot(const Gnuplot&) = delete;
  Gnuplot& operator=(const Gnuplot&) = delete;

  /// For commands and data.
  FILE* input() const { return input_; }

  /// Returns when everything is drawn. Throws std::runtime_error when gnuplot reports an error.
  void finish();

 private:
  int end();
  std::string warning() const;

  FILE* input_ = nullptr;
  std::unique_ptr<FILE, int (*)(FILE*)> warnings_;  // what it writes to its standard error
  pid_t process_ = -1;
};

}  // namespace spidar
