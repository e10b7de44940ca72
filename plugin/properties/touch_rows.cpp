// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/contact_force.h"
#include "plugin/properties/motion_rows.h"

namespace spidar {
namespace {

constexpr double kMostRelief_mm = 30;
constexpr double kLeastStiffness_N_m = 10;
constexpr double kMostTexture = 10;

}  // namespace

std::vector<MotionRow> touch_rows() {
  return {
      MotionRow::choice<TouchKind>(
          {"touch", "Touch", "Which surface the grip touches in the picture"},
          "GstSpidarMotionTouch",
          {{TouchKind::kOff, "No surface: the motion of the film is felt", "off"},
           {TouchKind::kLuma, "A relief of the frame's brightness: bright is near", "luma"},
           {TouchKind::kDepth, "A relief of the depth that is half of the frame, see depth-layout",
            "depth"}},
          kControllable, KEPT_IN(touch.kind)),
      MotionRow::choice<DepthLayout>(
          {"depth-layout", "Depth layout", "Where touch=depth finds the depth"},
          "GstSpidarMotionDepthLayout",
          {{DepthLayout::kRight,
            "The right half of the frame is the depth of the left half; bright is near", "right"},
           {DepthLayout::kBelow,
            "The lower half of the frame is the depth of the upper half; bright is near", "below"}},
          kControllable, KEPT_IN(touch.depth)),
      MotionRow::number(
          {"touch-relief", "Touch relief",
           "Height of the relief from black to white, or from far to near, in millimetres. "
           "Its middle is in the centre of the workspace"},
          0, kMostRelief_mm, kControllable, KEPT_IN(touch.relief_mm)),
      MotionRow::number(
          {"touch-stiffness", "Touch stiffness",
           "Stiffness of the surface, in newtons per metre. A device whose drives are slow, or "
           "were not measured, gets less, with a warning"},
          kLeastStiffness_N_m, ContactSettings::kMostStiffness_N_m, kControllable,
          KEPT_IN(touch.stiffness_N_m)),
      MotionRow::number(
          {"touch-friction", "Touch friction",
           "Coefficient of static friction of the surface; that of kinetic friction is "
           "four fifths of it"},
          0, 1, kControllable, KEPT_IN(touch.friction)),
      MotionRow::number(
          {"touch-texture", "Touch texture",
           "Lateral force of the picture's fine detail, as a multiple of the slope that it "
           "has in the relief; 0 turns it off"},
          0, kMostTexture, kControllable, KEPT_IN(touch.texture)),
      MotionRow::number(
          {"motion-share", "Motion share",
           "With touch, the share of the force of the film's motion that is added to the "
           "contact force. Without touch, all of it is felt"},
          0, 1, kControllable, KEPT_IN(touch.motion_share)),
  };
}

}  // namespace spidar
