// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads and saves the rules of the property `feel`, which choose what is felt.
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

/// Reads the rules that the property `feel` selects. Its value is the path of a file that ends in
/// `.feel`; "auto" for the file beside `film`, if there is one; or the text of the rules. Throws
/// std::runtime_error with a sentence that begins with NamedRules::name.
NamedRules read_feel(const std::string& feel, const std::string& film);

/// Whether the property `feel` is the path of a file.
bool is_feel_file(const std::string& feel);

/// Applies `edits` to the file that `feel` names, otherwise to the file beside `film`, and replaces
/// the file atomically. First copies a file that contains more than valid rules, such as comments,
/// to another name. Returns a sentence that describes what was done. On failure, leaves the file
/// unchanged and throws std::runtime_error with a sentence without a full stop.
std::string save_feel(const std::string& feel, const std::string& film,
                      const std::vector<FeelEdit>& edits);

}  // namespace spidar::filter
