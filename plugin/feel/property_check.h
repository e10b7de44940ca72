// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Properties of spidarmotion that were typed, checked before a player starts.
#pragma once

#include <string>
#include <vector>

#include <gst/gst.h>

#include "plugin/properties/typed_property.h"

namespace spidar {

/// `properties` are of the form NAME=VALUE; `element` is a spidarmotion in the state NULL. Sets its
/// `device` and `profile`, and no other property. Opens no device, so one that is not plugged in is
/// no error. Throws PropertyError, which says what is wrong and what would be right, for an unknown
/// property, a value that the property does not take, a name that no device has, and a profile that
/// cannot be read or does not suit the device.
void check_properties(GstElement* element, const std::vector<std::string>& properties);

}  // namespace spidar
