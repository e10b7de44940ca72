// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What StickTest found on a joystick or wheel, and what to do about it.
#pragma once

#include <string>

#include <Eigen/Core>

#include "spidar/grip/grip.h"
#include "spidar/selftest/stick_test.h"

namespace spidar {

/// `can`: what the device can do; `reach_m`: where the grip is when it is pushed all the way;
/// `device`: "ff" or "ff:PATH,flip=x", as it was tested.
std::string stick_report(const StickTest& test, const GripAbilities& can,
                         const Eigen::Vector2d& reach_m, const std::string& device);

}  // namespace spidar
