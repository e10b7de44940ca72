// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <optional>
#include <string>

#include <gst/gst.h>

#include "spidar/tools/command_line.h"

namespace spidar {

/// A property of spidarmotion as a user types it, NAME=VALUE. Sets nothing.
class TypedProperty {
 public:
  /// `element` is a spidarmotion. Throws tools::UsageError, which says what is wrong and what would
  /// be right, for an unknown property and a value that it does not accept.
  TypedProperty(GObject* element, const std::string& text);
  ~TypedProperty() { g_value_unset(&value_); }
  TypedProperty(const TypedProperty&) = delete;
  TypedProperty& operator=(const TypedProperty&) = delete;

  /// The registered name: `max-force`, even if the user typed `max_force`.
  std::string name() const { return g_param_spec_get_name(property_); }
  const GValue* value() const { return &value_; }
  bool is_default() const { return g_param_value_defaults(property_, &value_) != FALSE; }
  /// The same text for all ways to type a value: `2` and `2.0`.
  std::string canonical_value() const;

 private:
  GParamSpec* property_;
  GValue value_ = G_VALUE_INIT;
};

/// The name in `preset=NAME`; nothing for other texts.
std::optional<std::string> preset_of(const std::string& text);

/// Sets NAME=VALUE, or loads preset=NAME. Throws tools::UsageError as the two others do.
void set_typed(GstElement* element, const std::string& text);

/// Loads a preset of `element`. Throws tools::UsageError, which lists the presets.
void load_preset(GstElement* element, const std::string& name);

}  // namespace spidar
