// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Element properties as typed by a user.
#pragma once

#include <string>

#include <gst/gst.h>

/// Sets `name=value` of a command line. Throws std::invalid_argument that says what was wrong and
/// what would be right.
void set_property(GstElement* element, const std::string& assignment);
