// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a misspelt word was meant to be.
#pragma once

#include <string>
#include <vector>

namespace spidar {

/// "; did you mean max-force?" for a word that is nearly one of `known`; else empty.
std::string meant(const std::string& word, const std::vector<std::string>& known);

}  // namespace spidar
