// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the border of the picture shows of the camera's motion: objects are rarely there.
#pragma once

#include <vector>

#include "core/field/block_field.h"
#include "core/motion/camera/block_votes.h"
#include "core/motion/camera/motion_models.h"

namespace spidar {

/// A motion must explain more of the border's blocks than rest does by this fraction of them, to be
/// believed where votes show rest or nothing. Measured in rendered films, in 4594 pictures in which
/// areas moved and blocks did not: twelve pictures became right for each that became wrong, with
/// half of it eight, with none three.
constexpr double kMoreThanRest = 0.2;

/// Whether the blocks along the border, with texture or without, fit the picture before better if
/// they have moved like the model than if they rest. Known objects are left out; where they have
/// most of the border, it says nothing.
bool border_has_moved(const BlockField& field, const PreviousFrame& past, const MotionModel& model);

/// Fraction of the pixels of graphics that are exactly equal. With noise of one grey level after
/// reduction, 0.35 of the pixels of a static object are. Of graphics it is nearly all of them, or
/// 0.6 if an encoder adds noise; the standard deviation of the count is √n / 2.
constexpr double kExactOfGraphics = 0.5;
/// Whether pixels that stay while what is around them moves are graphics and not of an object that
/// the camera follows: more than `least_exact` of them are exactly equal.
bool are_graphics(const StayingPixels& staying, double least_exact);

/// No more models are compared.
constexpr size_t kMostModels = 4;

/// Sets `shares` to what each of the models explains of the border, as fractions of its blocks: one
/// that fits some motion clearly better than others counts, divided among the models that fit it.
/// Graphics do not count, if the first model moves. Returns the fraction of the blocks that count.
/// Of a single model, they are those that it does not explain, because a block always fits the
/// motion that was found for it.
double share_border(const BlockField& field, const PreviousFrame& past,
                    const std::vector<MotionModel>& models, std::vector<double>& shares);

}  // namespace spidar
