// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/motion_rows.h"

namespace spidar {

std::vector<MotionRow> feel_rows() {
  return {
      MotionRow::choice<ControllerKind>(
          {"controller", "Controller", "How speed is converted to force"},
          "GstSpidarMotionController",
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
          "GstSpidarMotionMotion",
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
           "What is felt when, instead of what 'motion' says: a file whose name ends in .feel, "
           "'auto' for the one beside the film (FILM.mp4.feel), or rules themselves, with "
           "semicolons between them: '0:00-0:12 object at 0.31,0.62; 0:12-0:20 camera gain 0.5'"},
          kPlaying, KEPT_IN(feel)),
      MotionRow::choice<PointerKind>(
          {"pointer", "Pointer", "Which position weights the objects of motion=objects"},
          "GstSpidarMotionPointer",
          {{PointerKind::kFixed, "At pointer-x, pointer-y", "fixed"},
           {PointerKind::kGrip,
            "Position of the grip; half of the way to the strings' exits is the edge of the "
            "picture",
            "grip"},
           {PointerKind::kMouse,
            "The mouse in the window of the video; a click keeps the object that is there, and the "
            "next one lets go. While the picture is touched, the left button leads the hand of the "
            "simulated device instead",
            "mouse"}},
          kControllable, KEPT_IN(pointer)),
      MotionRow::number(
          {"pointer-x", "Pointer x",
           "Horizontal position of the pointer: 0 is the left edge of the picture, 1 the "
           "right edge. pointer=grip uses it while no device runs, pointer=mouse before the mouse "
           "moves"},
          0, 1, kControllable, KEPT_IN(analyzer.pointer.x())),
      MotionRow::number(
          {"pointer-y", "Pointer y",
           "Vertical position of the pointer: 0 is the top of the picture, 1 the bottom"},
          0, 1, kControllable, KEPT_IN(analyzer.pointer.y())),
      MotionRow::number({"max-force", "Maximum force",
                         "Largest force on the grip, in newtons (Fmax of eq. 12 and 15)"},
                        0, 20, kControllable, KEPT_IN(analyzer.controller.max_force_N)),
      MotionRow::number(
          {"alpha", "Alpha",
           "How quickly force rises with speed (nonlinear and adaptive controller), in "
           "seconds per pixel of a frame 480 lines high: half of the maximum force is "
           "reached at 1/alpha px/s"},
          1e-6, 10, kControllable, KEPT_IN(analyzer.controller.alpha_s_px)),
      MotionRow::number(
          {"depth-gain", "Depth gain",
           "Force towards the viewer when the object grows. With 1, growth counts as the "
           "speed that it causes at half a frame's height from the centre; 0 turns it "
           "off"},
          0, 100, kControllable, KEPT_IN(analyzer.axes.depth)),
      MotionRow::number(
          {"roll-gain", "Roll gain",
           "Torque about the view axis when the object turns. With 1, rotation counts as "
           "the speed that it causes at half a frame's height from the centre; 0 turns it "
           "off"},
          0, 100, kControllable, KEPT_IN(analyzer.axes.roll)),
      MotionRow::number(
          {"filter-min-cutoff", "Filter minimum cutoff",
           "Cutoff frequency of the motion's One-Euro filter while the motion is steady, "
           "in Hz. Lower values are smoother and delay by 1/(2 pi cutoff) seconds; 0 turns "
           "the filter off"},
          0, 1000, kControllable, KEPT_IN(analyzer.filter.min_cutoff_Hz)),
      MotionRow::number(
          {"filter-beta", "Filter beta",
           "How much the One-Euro filter's cutoff rises with the motion's rate of change, "
           "in Hz per px/s^2 of a frame 480 lines high"},
          0, 10, kControllable, KEPT_IN(analyzer.filter.beta_s_px)),
  };
}

}  // namespace spidar
