// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/choice/feel_rules.h"
#include "core/wrench_size.h"
#include "plugin/device/device_view.h"
#include "plugin/frame/frame_report.h"
#include "spidar/text.h"

namespace spidar::window {

/// A property of the element that can be changed while it plays.
struct Setting {
  enum class Kind { kSwitch, kChoice, kWhole, kNumber };
  struct Choice {
    int value = 0;
    std::string name;
  };
  std::string name;
  std::string help;
  Kind kind = Kind::kNumber;
  double value = 0, low = 0, high = 0;
  std::vector<Choice> choices;
  double usual = 0;  ///< the default of a number
};

/// The present state of the element, as plain data without GL and GObject.
struct ElementState {
  std::string name;
  bool is_playing = false;           ///< whether its state is PLAYING
  bool has_ended = false;            ///< whether the last frame is on the screen
  std::optional<DeviceView> device;  ///< nothing with device=none or while it is closed
  std::vector<Setting> settings;
  std::vector<std::string> presets;  ///< by name
  std::string no_force;  ///< why there was no force in the last second; empty: there was
  std::shared_ptr<const FeelRules> rules;  ///< of `feel`; null: there are none

  /// Returns null when there is no setting of this name.
  const Setting* setting(const std::string& setting_name) const {
    const auto found = std::find_if(settings.begin(), settings.end(),
                                    [&](const Setting& s) { return s.name == setting_name; });
    return found == settings.end() ? nullptr : &*found;
  }
  double value(const std::string& setting_name, double otherwise) const {
    const Setting* found = setting(setting_name);
    return found ? found->value : otherwise;
  }
};

/// Returns the last line of the window: "felt", or "not felt: " and why; "felt: " and why, while
/// the force is only lowered. `now` is the present wrench, `no_force` covers the last second.
/// While the surface is touched, also tells when less stiffness is rendered than is set.
inline std::string felt_line(const ElementState& state, const TouchScene& touch,
                             const Wrench& now) {
  if (state.has_ended) return state.no_force;
  const bool is_felt = size_N(now) >= kFeltForce_N;
  if (!state.no_force.empty()) return (is_felt ? "felt: " : "not felt: ") + state.no_force;
  if (!is_felt) return "felt within the last second";
  const double wanted_N_m = state.value("touch-stiffness", 0);
  if (!touch.on || touch.stiffness_N_m >= wanted_N_m) return "felt";
  return formatted("felt, at %.0f N/m instead of %.0f: the device's drives are slow",
                   touch.stiffness_N_m, wanted_N_m);
}

}  // namespace spidar::window
