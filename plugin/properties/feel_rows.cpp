// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/motion_rows.h"
#include "plugin/properties/pointer_text.h"

namespace spidar {
namespace {

/// What cannot be read leaves the pointer as it was, with a warning, as GObject does it.
void set_pointer(MotionProperties& properties, const GValue* value) {
  const char* const text = g_value_get_string(value);
  const std::optional<Pointer> pointer = parse_pointer(text ? text : "");
  if (pointer) {
    properties.pointer = pointer->kind;
    properties.analyzer.pointer = pointer->place;
  } else {
    g_warning("pointer=\"%s\" is neither 'grip' nor 'mouse' nor a place X,Y, each from 0 to 1",
              text ? text : "");
  }
}

MotionRow pointer_row() {
  return {[](const MotionProperties&) {
            return g_param_spec_string(
                "pointer", "Pointer",
                "Which place weights the objects of motion=objects: 'grip', 'mouse', or X,Y as "
                "shares of the picture from its top left corner",
                kMiddle, kPlaying);
          },
          set_pointer,
          [](const MotionProperties& properties, GValue* value) {
            g_value_take_string(
                value,
                g_strdup(text_of({properties.pointer, properties.analyzer.pointer}).c_str()));
          }};
}

}  // namespace

std::vector<MotionRow> feel_rows() {
  return {
      MotionRow::choice<ControllerKind>(
          {"controller", "Controller", "How speed is converted to force"}, "GstSpidarController",
          {{ControllerKind::kLinear, "Linear: full force at the largest speed so far (eq. 11-13)",
            "linear"},
           {ControllerKind::kNonlinear, "Nonlinear: arctangent of the speed (eq. 14-15)",
            "nonlinear"},
           {ControllerKind::kAdaptive,
            "Adaptive: nonlinear, with an alpha that follows the speeds of the scene (a tenth to "
            "ten times the one that is set) and no force below the measurement's noise",
            "adaptive"}},
          kControllable, KEPT_IN(analyzer.controller.kind)),
      MotionRow::choice<MotionKind>(
          {"motion", "Motion", "Which motion in the picture is rendered as force"},
          "GstSpidarFeltMotion",
          {{MotionKind::kMean,
            "Mean velocity of OpenCV's Shi-Tomasi points, tracked by pyramidal Lucas-Kanade: "
            "closest to the paper (eq. 1-10)",
            "mean"},
           {MotionKind::kObject,
            "The dominant object relative to the background; no force when only the camera moves",
            "object"},
           {MotionKind::kObjects,
            "All objects relative to the background, weighted by area and by distance from the "
            "pointer",
            "objects"},
           {MotionKind::kCamera, "The motion of the camera, as if the viewer moved with it",
            "camera"}},
          kControllable, KEPT_IN(analyzer.motion)),
      MotionRow::text(
          {"feel", "Feel",
           "Rules that say what is felt when: a .feel file, 'auto' for FILM.mp4.feel, or the rules "
           "themselves, with semicolons between them"},
          kPlaying, KEPT_IN(feel)),
      pointer_row(),
      MotionRow::number({"max-force", "Maximum force",
                         "Largest force on the grip, in newtons (Fmax of eq. 12 and 15)"},
                        0, 20, kControllable, KEPT_IN(analyzer.controller.max_force_N)),
      MotionRow::number(
          {"alpha", "Alpha",
           "How quickly force rises with speed, in s/px at 480 lines: half of max-force is reached "
           "at 1/alpha px/s. Not with controller=linear"},
          1e-6, 10, kControllable, KEPT_IN(analyzer.controller.alpha_s_px)),
      MotionRow::number(
          {"depth-gain", "Depth gain",
           "Force towards the viewer when the object grows: factor of the speed that growth causes "
           "at half a frame's height. 0: none"},
          0, 100, kControllable, KEPT_IN(analyzer.axes.depth)),
      MotionRow::number(
          {"roll-gain", "Roll gain",
           "Torque about the view axis when the object turns: factor of the speed that turning "
           "causes at half a frame's height. 0: none"},
          0, 100, kControllable, KEPT_IN(analyzer.axes.roll)),
      MotionRow::number(
          {"filter-min-cutoff", "Filter minimum cutoff",
           "Cutoff of the One-Euro filter while the motion is steady, in Hz; delays by 1/(2 pi "
           "cutoff) seconds. 0: no filter"},
          0, 1000, kControllable, KEPT_IN(analyzer.filter.min_cutoff_Hz)),
      MotionRow::number(
          {"filter-beta", "Filter beta",
           "How much the filter's cutoff rises with the motion's rate of change, in Hz per px/s^2 "
           "at 480 lines"},
          0, 10, kControllable, KEPT_IN(analyzer.filter.beta_s_px)),
  };
}

}  // namespace spidar
