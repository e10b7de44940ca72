// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How the settings of the element are shown: their groups, plain names and units.
#pragma once

#include <string>
#include <vector>

#include "plugin/window/program/model/window_model.h"

namespace spidar {

struct SettingText {
  const char* property;
  const char* label;
  const char* unit;  ///< empty for a number without one
  double per_unit;   ///< of the property's own units in one of `unit`
};

struct SettingGroup {
  const char* name;
  std::vector<SettingText> settings;
};

/// All groups in the order in which they are shown. `mute` is none of them: it has a button.
const std::vector<SettingGroup>& setting_groups();

/// Whether a value differs from the property's default by more than rounding.
bool is_changed(const Setting& setting);

}  // namespace spidar
