// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// --help of programs whose other options have no parser.
#pragma once

#include <cstdio>
#include <string>

/// Prints `usage` on standard output when it is asked for by --help or -h as the first argument.
inline bool asks_for_help(int argc, char** argv, const std::string& usage) {
  const std::string first = argc > 1 ? argv[1] : "";
  const bool asks = first == "--help" || first == "-h";
  if (asks) std::fputs(usage.c_str(), stdout);
  return asks;
}
