// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the border of the picture shows of the camera's motion: objects are rarely there.
#pragma once

#include <vector>

#include "core/field/block_field.h"
#include "core/motion/camera/block_votes.h"
#include "core/motion/camera/motion_models.h"

namespace spidar {

/// Whether the blocks along the border, with texture or without, fit the picture before better if
/// they have moved like the model than if they rest. Known objects are left out; where they have
/// most of the border, it says nothing.
bool border_has_moved(const BlockField& field, const Past& past, const MotionModel& model);

/// No more models are compared.
constexpr size_t kMostModels = 4;

/// Sets `shares` to what each of the models explains of the border, as fractions of its blocks: one
/// that fits some motion clearly better than others counts, divided among the models that fit it.
/// Returns the fraction of the blocks that count. Of a single model, they are those that it does
/// not explain, because a block always fits the motion that was found for it.
double share_border(const BlockField& field, const Past& past,
                    const std::vector<MotionModel>& models, std::vector<double>& shares);

}  // namespace spidar
