// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <vector>

#include "core/field/block_field.h"
#include "core/motion/camera/block_votes.h"
#include "core/motion/camera/motion_models.h"

namespace spidar {

/// Where votes show rest or nothing, a motion counts only if it explains more of the border's
/// blocks than rest does, by this fraction of them. Measured in rendered films, in 4594 pictures in
/// which coarse blocks moved and blocks did not: twelve pictures became right for each that became
/// wrong; with half this fraction eight, with 0 three.
constexpr double kMoreThanRest = 0.2;

/// Tests the camera's motion at the border of the picture, where objects are rare: whether the
/// blocks along the border, with texture or without, fit the previous picture better if they have
/// moved like the model than if they rest. Known objects are left out; where they have most of the
/// border, the answer is false.
bool border_has_moved(const BlockField& field, const PreviousFrame& past, const MotionModel& model);

/// The least fraction of exactly equal pixels in graphics. With noise of one grey level after
/// reduction, 0.35 of the pixels of a static object are equal; of graphics nearly all are, or 0.6
/// if an encoder adds noise. The standard deviation of the count is √n / 2.
constexpr double kExactOfGraphics = 0.5;
/// Whether pixels that stay while their surroundings move belong to graphics and not to an object
/// that the camera follows: more than `least_exact` of them are exactly equal.
bool are_graphics(const StayingPixels& staying, double least_exact);

/// The largest number of compared models.
constexpr size_t kMaxModels = 4;

/// Sets `shares` to the fraction of the border's blocks that each model explains. A block counts if
/// some motion fits it clearly better than another, and is divided among the models that fit it.
/// Graphics do not count if the first model moves. Returns the fraction of the blocks that count.
/// With a single model, these are the blocks that it does not explain, because a block always fits
/// the motion that was found for it.
double divide_border(const BlockField& field, const PreviousFrame& past,
                     const std::vector<MotionModel>& models, std::vector<double>& shares);

}  // namespace spidar
