// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What programs and exceptions say.
#pragma once

#include "tests/support/test.h"

namespace spidar::test {

inline void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << '"' << part << "\" is not in:\n" << text;
}

/// The message of the exception that the call throws; empty if it throws none.
template <typename Error, typename Call>
std::string message_of(const Call& call) {
  try {
    call();
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace spidar::test
