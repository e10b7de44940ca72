// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Maps of the force that a device delivers, over the plane of the screen and over rotations.
#pragma once

#include <filesystem>

#include "spidar/profiles/profile.h"

/// Writes PROFILE-position.csv and PROFILE-rotation.csv into `folder` and draws them as
/// PROFILE.png.
///
/// The first covers x and y (mm) of the frame at z = 0 without rotation, the second the rotation
/// vector (degrees) about x and y at the centre. Columns: the two coordinates and the tension
/// factor; then, for the weights of the loop and for the published ones, the smallest force (N,
/// along the wanted one) and the largest unwanted moment (N mm) over all directions.
///
/// Throws std::runtime_error or std::filesystem::filesystem_error.
void draw_map(const spidar::Profile& profile, const std::filesystem::path& folder);
