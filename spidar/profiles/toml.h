// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// toml++, which is included only here: its parser calls assert() where the name of a table begins
/// with a wrong character, as "[~]" (3.0 to 3.3), and assumes without it that none does. A file
/// ends no program, so std::logic_error is thrown, beside toml::parse_error. What is noexcept there
/// ends the program, as with assert(), of which GCC warns.
#pragma once

#include <stdexcept>

#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expression) \
  ((expression) ? void() : throw std::logic_error("a name has a wrong character"))

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wterminate"
#endif

#include <toml++/toml.h>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
#pragma pop_macro("NDEBUG")
