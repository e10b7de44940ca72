// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Files that lie beside a film: its track, its analysis, the rules of what is felt.
#pragma once

#include <fstream>
#include <initializer_list>
#include <string>

namespace spidar {

/// FILM with one of `ends`, else the same without the extension of FILM: the first of them that is
/// there; empty when none is. The whole name comes first because films may differ in nothing else.
std::string find_beside(const std::string& film, std::initializer_list<const char*> ends);

/// The file that find_beside() finds although `file`, which is also one of these, is there; empty
/// when there is none.
std::string find_before(const std::string& film, std::initializer_list<const char*> ends,
                        const std::string& file);

/// Throws std::runtime_error, which says what is wrong, when `path` is not a regular file or cannot
/// be read.
std::ifstream open_regular_file(const std::string& path);

}  // namespace spidar
