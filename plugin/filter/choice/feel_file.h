// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The rules of what is felt, beside a film or from anywhere else.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/choice/feel_rules.h"

namespace spidar::filter {

/// What is appended to the name of a film.
constexpr const char* kFeelEnd = ".feel";

struct NamedRules {
  std::shared_ptr<const FeelRules> rules;  ///< null: there are none
  std::string name;                        ///< "feel", or the path of the file
};

/// What the property `feel` means: the path of a file, which ends in `.feel`; "auto" for the one
/// beside the file `film`, if there is one; else the rules themselves. Throws std::runtime_error
/// with a sentence that begins with the name.
NamedRules read_feel(const std::string& feel, const std::string& film);

/// Whether the property `feel` is the path of a file.
bool is_feel_file(const std::string& feel);

/// Changes the file that `feel` names, else the one beside `film`, which appears at once and as a
/// whole. One that has more than its rules, such as remarks, or mistakes is kept under another
/// name. Returns what was done, as a sentence; throws std::runtime_error with one without a full
/// stop, and then the file is what it was.
std::string save_feel(const std::string& feel, const std::string& film,
                      const std::vector<FeelEdit>& edits);

}  // namespace spidar::filter
