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
          {"touch", "Touch", "Which surface the grip touches in the picture"}, "GstSpidarTouch",
          {{TouchKind::kOff, "No surface: the motion of the film is felt", "off"},
           {TouchKind::kLuma, "A relief of the frame's brightness: bright is near", "luma"},
           {TouchKind::kDepth,
            "A relief of the depth in the right half of the frame, of what the left half shows: "
            "bright is near",
            "depth"},
           {TouchKind::kDepthBelow, "The same, with the depth in the lower half of the frame",
            "depth-below"}},
          kControllable, KEPT_IN(touch.kind)),
      MotionRow::number(
          {"touch-relief", "Touch relief",
           "Height of the relief from black to white, or from far to near, in millimetres, about "
           "the centre of the workspace"},
          0, kMostRelief_mm, kControllable, KEPT_IN(touch.relief_mm)),
      MotionRow::number(
          {"touch-stiffness", "Touch stiffness",
           "Stiffness of the surface, in newtons per metre. A device with slow or unmeasured "
           "drives gets less, with a warning"},
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
           "With touch, the share of the force of the film's motion that is felt besides. Without "
           "touch, all of it is"},
          0, 1, kControllable, KEPT_IN(touch.motion_share)),
  };
}

}  // namespace spidar
