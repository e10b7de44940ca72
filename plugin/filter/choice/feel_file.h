// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Rules of what is felt, from a file beside the film or from anywhere else.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/choice/feel_rules.h"

namespace spidar::filter {

/// The suffix of a file of rules, after the name of its film.
constexpr const char* kFeelEnd = ".feel";

struct NamedRules {
  std::shared_ptr<const FeelRules> rules;  ///< null: there are no rules
  std::string name;                        ///< "feel", or the path of the file
};

/// Reads the rules that the property `feel` means: the path of a file, which ends in `.feel`;
/// "auto" for the file beside the film `film`, if there is one; else the rules themselves. Throws
/// std::runtime_error with a sentence that begins with NamedRules::name.
NamedRules read_feel(const std::string& feel, const std::string& film);

/// Whether the property `feel` is the path of a file.
bool is_feel_file(const std::string& feel);

/// Applies `edits` to the file that `feel` names, else to the one beside `film`, and replaces the
/// whole file at once. If the file contained mistakes, or more than rules, such as remarks, a copy
/// stays under another name. Returns a sentence that says what was done. On failure, leaves the
/// file as it was and throws std::runtime_error with a sentence that has no full stop.
std::string save_feel(const std::string& feel, const std::string& film,
                      const std::vector<FeelEdit>& edits);

}  // namespace spidar::filter
