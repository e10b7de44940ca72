// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/force/gain_controller.h"
#include "plugin/window/view/window_view.h"

namespace spidar::window {

/// Two settings of the element to compare, of which one is in use. Both begin as those of the
/// element; then each stores the changes while it is in use, except for the stop of the force.
class SettingsComparison {
 public:
  /// The element has refused a change that is still missing after this many of its answers: earlier
  /// answers may have been on their way when the change was requested.
  static constexpr int kMaxAnswers = 30;

  /// Takes the present settings of the element.
  void update(const std::vector<Setting>& settings) {
    if (!asked_.empty() && ++answers_ > kMaxAnswers) asked_.clear();
    for (const Setting& setting : settings) {
      if (setting.name == "mute") continue;
      const auto [seen, is_new] = seen_.emplace(setting.name, setting.value);
      if (is_new) {
        first_[setting.name] = setting.value;
        for (std::map<std::string, double>& values : kept_) values[setting.name] = setting.value;
      }
      const auto asked = asked_.find(setting.name);
      if (asked == asked_.end()) {
        // Only changes count: the other setting's value may have been refused.
        if (seen->second != setting.value) kept_[used_][setting.name] = setting.value;
      } else if (asked->second == setting.value) {
        asked_.erase(asked);
      }
      seen->second = setting.value;
    }
  }

  size_t used() const { return used_; }
  const std::map<std::string, double>& other() const { return kept_[1 - used_]; }
  bool are_same() const { return kept_[0] == kept_[1]; }

  /// Uses `which` (0 or 1) from now on. Returns the properties to set.
  std::vector<std::pair<std::string, double>> use(size_t which) {
    used_ = which;
    return changes_to(kept_[which]);
  }
  /// Resets the setting in use to the first values. Returns the properties to set.
  std::vector<std::pair<std::string, double>> reset() {
    kept_[used_] = first_;
    return changes_to(first_);
  }

 private:
  std::vector<std::pair<std::string, double>> changes_to(
      const std::map<std::string, double>& values) {
    std::vector<std::pair<std::string, double>> changes;
    for (const auto& [name, value] : values) {
      const auto asked = asked_.find(name);
      if ((asked == asked_.end() ? seen_.at(name) : asked->second) == value) continue;
      changes.emplace_back(name, value);
      asked_[name] = value;
    }
    answers_ = 0;
    return changes;
  }

  std::map<std::string, double> first_, seen_;
  std::map<std::string, double> asked_;  ///< requested values that have not come yet
  int answers_ = 0;                      ///< since the request
  std::array<std::map<std::string, double>, 2> kept_;
  size_t used_ = 0;
};

/// `controller` with those of its settings that `values` contains.
inline ControllerSettings with_values(ControllerSettings controller,
                                      const std::map<std::string, double>& values) {
  const auto value = [&](const char* name, double otherwise) {
    const auto found = values.find(name);
    return found == values.end() ? otherwise : found->second;
  };
  controller.law = static_cast<ControlLaw>(
      static_cast<int>(value("controller", static_cast<int>(controller.law))));
  controller.max_force_N = value("max-force", controller.max_force_N);
  controller.alpha_s_px = value("alpha", controller.alpha_s_px);
  return controller;
}

}  // namespace spidar::window
