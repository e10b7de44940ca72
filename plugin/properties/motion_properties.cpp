// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/motion_properties.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/touch/contact_force.h"
#include "plugin/properties/device_rows.h"
#include "plugin/properties/property_table.h"

namespace spidar {
namespace {

using MotionRow = Property<MotionProperties>;

/// A property whose text `parse` reads. A text that it rejects leaves the value unchanged and is
/// reported by a warning with the text `neither`, as in GObject.
template <typename Value>
MotionRow parsed(PropertyNames n, std::optional<Value> (*parse)(const std::string&),
                 Value (*get)(const MotionProperties&),
                 void (*set)(MotionProperties&, const Value&), const std::string& neither) {
  return {[=](const MotionProperties& defaults) {
            return g_param_spec_string(n.name, n.nick, n.blurb, text_of(get(defaults)).c_str(),
                                       kPlaying);
          },
          [=](MotionProperties& properties, const GValue* value) {
            const char* const text = g_value_get_string(value) ? g_value_get_string(value) : "";
            const std::optional<Value> read = parse(text);
            if (read) {
              set(properties, *read);
            } else {
              g_warning("%s=\"%s\" is neither %s", n.name, text, neither.c_str());
            }
          },
          [=](const MotionProperties& properties, GValue* value) {
            g_value_set_string(value, text_of(get(properties)).c_str());
          }};
}

/// Unless the user sets alpha, motion=mean gets the steepness that is closest to the paper, because
/// the still background makes mean velocities small (docs/feeling.md, What can be told apart).
void follow_motion(MotionProperties& properties) {
  constexpr double kOfMean_s_px = 0.01;
  if (properties.alpha_is_set) return;
  properties.analyzer.controller.alpha_s_px = properties.analyzer.motion == MotionKind::kMean
                                                  ? kOfMean_s_px
                                                  : ControllerSettings().alpha_s_px;
}

MotionRow with(MotionRow row, void (*then)(MotionProperties&)) {
  row.set = [set = std::move(row.set), then](MotionProperties& properties, const GValue* value) {
    set(properties, value);
    then(properties);
  };
  return row;
}

MotionRow pointer_row() {
  return parsed<Pointer>(
      {"pointer", "Pointer",
       "Position that weights the objects of motion=objects: 'grip', 'mouse', or X,Y as fractions "
       "of the picture from its top left"},
      parse_pointer,
      [](const MotionProperties& properties) {
        return Pointer{properties.pointer, properties.analyzer.pointer};
      },
      [](MotionProperties& properties, const Pointer& pointer) {
        properties.pointer = pointer.kind;
        properties.analyzer.pointer = pointer.position;
      },
      "'grip' nor 'mouse' nor a position X,Y, each from 0 to 1");
}

MotionRow area_row() {
  return parsed<AreaSetting>(
      {"area", "Area",
       "Part of the picture that is analysed: 'whole', 'auto' (where it changes and the rest does "
       "not), or X,Y,WIDTH,HEIGHT in pixels or fractions"},
      parse_area, [](const MotionProperties& properties) { return properties.analyzer.area; },
      [](MotionProperties& properties, const AreaSetting& area) {
        properties.analyzer.area = area;
      },
      "'whole' nor 'auto' nor X,Y,WIDTH,HEIGHT, four fractions of the picture from 0 to 1, or four "
      "whole numbers of pixels with a width and height of at least " +
          std::to_string(kMinSide_px));
}

std::vector<MotionRow> marked(std::vector<MotionRow> rows) {
  for (MotionRow& row : rows) {
    row.spec = [spec = row.spec](const MotionProperties& defaults) {
      GParamSpec* const made = spec(defaults);
      g_param_spec_set_qdata(made, analysis_mark(), GINT_TO_POINTER(TRUE));
      return made;
    };
  }
  return rows;
}

/// Which motion is felt, and how: from `controller` to `washout`.
std::vector<MotionRow> analysis_rows() {
  return {
      MotionRow::choice<ControlLaw>(
          {"controller", "Controller", "How speed is converted to force"}, "GstSpidarController",
          {{ControlLaw::kLinear, "Linear: full force at the largest speed so far (eq. 11-13)",
            "linear"},
           {ControlLaw::kNonlinear, "Nonlinear: arctangent of the speed (eq. 14-15)", "nonlinear"},
           {ControlLaw::kAdaptive,
            "Adaptive: nonlinear, with an alpha that follows the scene (a tenth to ten times the "
            "one that is set) and a dead zone for slow motions",
            "adaptive"}},
          kControllable, KEPT_IN(analyzer.controller.law)),
      with(MotionRow::choice<MotionKind>(
               {"motion", "Motion", "Motion that becomes force"}, "GstSpidarFeltMotion",
               {{MotionKind::kMean,
                 "Mean velocity of OpenCV's Shi-Tomasi points, tracked by pyramidal Lucas-Kanade: "
                 "closest to the paper (eq. 1-10)",
                 "mean"},
                {MotionKind::kObject,
                 "The object that stands out most, relative to the background; no force when only "
                 "the camera moves",
                 "object"},
                {MotionKind::kObjects,
                 "All objects: their mean relative to the background, weighted by area and by "
                 "distance from the pointer",
                 "objects"},
                {MotionKind::kCamera, "The camera, as if the viewer moved with it", "camera"}},
               kControllable, KEPT_IN(analyzer.motion)),
           follow_motion),
      MotionRow::text({"feel", "Feel",
                       "Rules that say what is felt when: a .feel file, 'auto' for FILM.mp4.feel, "
                       "or the rules, with semicolons between them"},
                      kPlaying, KEPT_IN(feel)),
      area_row(),
      pointer_row(),
      MotionRow::number({"max-force", "Maximum force",
                         "Largest force on the grip, in newtons (Fmax of eq. 12 and 15)"},
                        0, 20, kControllable, KEPT_IN(analyzer.controller.max_force_N)),
      with(MotionRow::number(
               {"alpha", "Alpha",
                "How quickly force rises with speed, in s/px at 480 lines: half of max-force at "
                "1/alpha px/s. Until set, 0.01 with motion=mean. Not for controller=linear"},
               1e-6, 10, kControllable, KEPT_IN(analyzer.controller.alpha_s_px)),
           [](MotionProperties& properties) { properties.alpha_is_set = true; }),
      MotionRow::number({"depth-gain", "Depth gain",
                         "Force towards the viewer when the object grows: factor of the speed that "
                         "growth causes at half a frame's height"},
                        0, 100, kControllable, KEPT_IN(analyzer.axes.depth)),
      MotionRow::number({"roll-gain", "Roll gain",
                         "Torque about the view axis when the object turns: factor of the speed "
                         "that turning causes at half a frame's height"},
                        0, 100, kControllable, KEPT_IN(analyzer.axes.roll)),
      MotionRow::number({"filter-min-cutoff", "Filter minimum cutoff",
                         "Cutoff of the One-Euro filter in a steady motion, in Hz; delays by 1/(2 "
                         "pi cutoff) seconds. 0: no filter"},
                        0, 1000, kControllable, KEPT_IN(analyzer.filter.min_cutoff_Hz)),
      MotionRow::number({"filter-beta", "Filter beta",
                         "How much the filter's cutoff rises with the motion's rate of change, in "
                         "s/px at 480 lines"},
                        0, 10, kControllable, KEPT_IN(analyzer.filter.beta_s_px)),
      MotionRow::number({"washout", "Washout",
                         "Cutoff below which the force fades, in Hz: what lasts falls to 37 % in "
                         "1/(2 pi cutoff) seconds, while changes pass"},
                        0, 1, kControllable, KEPT_IN(analyzer.washout_Hz)),
  };
}

std::vector<MotionRow> display_rows() {
  return {
      MotionRow::choice<DisplayProperties::Overlay>(
          {"overlay", "Overlay", "What is drawn into the video"}, "GstSpidarOverlay",
          {{DisplayProperties::Overlay::kNone, "Nothing", "none"},
           {DisplayProperties::Overlay::kForce,
            "The outlines of objects and the force that is felt", "force"},
           {DisplayProperties::Overlay::kPoints, "Small arrows of the motion, too", "points"},
           {DisplayProperties::Overlay::kCurve,
            "Outlines, the force, and its curve over the last five seconds", "curve"}},
          kPlaying, KEPT_IN(display.overlay)),
      MotionRow::number({"arrow-scale", "Arrow scale",
                         "Length of a point's arrow, as a multiple of its displacement"},
                        0.1, 100, kControllable, KEPT_IN(display.arrow_scale)),
      MotionRow::on_off({"debug-window", "Debug window",
                         "Show what is measured and felt in a window. Becomes false when it is "
                         "closed or cannot be opened"},
                        kPlaying, KEPT_IN(display.debug_window)),
      MotionRow::on_off(
          {"attach-meta", "Attach meta",
           "Attach motion, points, wrench and the boxes of objects to each frame as metas"},
          kPlaying, KEPT_IN(display.attach_meta)),
  };
}

constexpr double kMaxRelief_mm = 30;
constexpr double kMinStiffness_N_m = 10;
constexpr double kMaxTexture = 10;

std::vector<MotionRow> touch_rows() {
  return {
      MotionRow::choice<TouchProperties::Kind>(
          {"touch", "Touch", "Which surface the grip touches in the picture"}, "GstSpidarTouch",
          {{TouchProperties::Kind::kOff, "No surface: the motion of the film is felt", "off"},
           {TouchProperties::Kind::kLuma, "A relief of the frame's brightness: bright is near",
            "luma"},
           {TouchProperties::Kind::kDepth,
            "A relief of the depth in the right half of the frame: bright is near", "depth"},
           {TouchProperties::Kind::kDepthBelow,
            "The same, with the depth in the lower half of the frame", "depth-below"}},
          kControllable, KEPT_IN(touch.kind)),
      MotionRow::number({"touch-relief", "Touch relief",
                         "Height of the relief from far to near, in millimetres, about the centre "
                         "of the workspace"},
                        0, kMaxRelief_mm, kControllable, KEPT_IN(touch.relief_mm)),
      MotionRow::number({"touch-stiffness", "Touch stiffness",
                         "Stiffness of the surface, in N/m. A device with slow or unmeasured "
                         "drives gets less, with a warning"},
                        kMinStiffness_N_m, touch::ContactSettings::kMaxStiffness_N_m, kControllable,
                        KEPT_IN(touch.stiffness_N_m)),
      MotionRow::number(
          {"touch-friction", "Touch friction",
           "Coefficient of static friction; that of kinetic friction is four fifths of it"},
          0, 1, kControllable, KEPT_IN(touch.friction)),
      MotionRow::number(
          {"touch-texture", "Touch texture",
           "Lateral force of the picture's fine detail, as a multiple of its slope in the relief"},
          0, kMaxTexture, kControllable, KEPT_IN(touch.texture)),
      MotionRow::number(
          {"motion-fraction", "Motion fraction",
           "With touch, the fraction of the force of the film's motion that is felt besides"},
          0, 1, kControllable, KEPT_IN(touch.motion_fraction)),
  };
}

MotionRow device_row() {
  return MotionRow::text(
      {"device", "Device",
       "Haptic device: 'sim' (simulated SPIDAR), one that 'spidarctl list' prints, 'auto' (what is "
       "plugged in), or 'none'. Opened from NULL to READY"},
      kNull, KEPT_IN(device));
}

/// The properties of the element as a whole, from `ts-offset` to `track`.
std::vector<MotionRow> element_rows() {
  return {
      MotionRow::offset({"ts-offset", "Timestamp offset",
                         "How much later than its frame the force is rendered, in nanoseconds; "
                         "earlier if negative"},
                        -10 * GST_SECOND, 10 * GST_SECOND, kControllable, KEPT_IN(ts_offset_ns)),
      on_device_error_row<MotionProperties>(),
      MotionRow::on_off({"post-messages", "Post messages",
                         "Post a 'spidar-motion' element message for each frame, while fewer than "
                         "1000 wait on the bus"},
                        kPlaying, KEPT_IN(post_messages)),
      MotionRow::text({"trace", "Trace",
                       "File that gets a line for each frame, with motion and force: .csv, or "
                       ".jsonl with background and objects too"},
                      kReady, KEPT_IN(trace)),
      haptic_trace_row<MotionProperties>(),
      MotionRow::statistics(
          {"stats", "Statistics",
           "Statistics: frames, analysis time, state and timing of the haptic loop"}),
      MotionRow::on_off(
          {"mute", "Mute",
           "No force: it ramps to zero at once, and returns with the next frame after this is "
           "false"},
          kControllable, KEPT_IN(mute)),
      MotionRow::text(
          {"track", "Track",
           "Haptic track felt instead of analysing frames: a file, or 'auto' for "
           "FILM.mp4.haptic.flac, .mka or .wav, the track inside the film, FILM.funscript or "
           "FILM.hjif"},
          kReady, KEPT_IN(track)),
  };
}

}  // namespace

const PropertyTable<MotionProperties>& motion_properties() {
  // Never destroyed: a thread may still set a property while the process ends.
  static const auto& table =
      *new PropertyTable<MotionProperties>{{device_row(), profile_row<MotionProperties>()},
                                           marked(analysis_rows()),
                                           element_rows(),
                                           display_rows(),
                                           touch_rows()};
  return table;
}

std::optional<Pointer> parse_pointer(const std::string& text) {
  Pointer pointer;
  if (text == "grip" || text == "mouse") {
    pointer.kind = text == "grip" ? Pointer::Kind::kGrip : Pointer::Kind::kMouse;
    return pointer;
  }
  // g_ascii_strtod() ignores the locale.
  gchar* end = nullptr;
  const double x = g_ascii_strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != ',') return std::nullopt;
  const char* const second = end + 1;
  const double y = g_ascii_strtod(second, &end);
  if (end == second || *end != '\0') return std::nullopt;
  if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) return std::nullopt;
  pointer.position = {x, y};
  return pointer;
}

std::string text_of(const Pointer& pointer) {
  if (pointer.kind == Pointer::Kind::kGrip) return "grip";
  if (pointer.kind == Pointer::Kind::kMouse) return "mouse";
  char x[G_ASCII_DTOSTR_BUF_SIZE], y[G_ASCII_DTOSTR_BUF_SIZE];
  return std::string(g_ascii_formatd(x, sizeof x, "%g", pointer.position.x())) + "," +
         g_ascii_formatd(y, sizeof y, "%g", pointer.position.y());
}

std::optional<AreaSetting> parse_area(const std::string& text) {
  AreaSetting area;
  if (text == "auto") return area;
  area.kind = AreaSetting::Kind::kWhole;
  if (text == "whole") return area;
  if (text.find_first_not_of("0123456789.,") != std::string::npos) return std::nullopt;
  std::array<double, 4> numbers;
  const char* next = text.c_str();
  for (double& number : numbers) {
    gchar* end = nullptr;
    number = g_ascii_strtod(next, &end);
    const char after = &number == &numbers.back() ? '\0' : ',';
    if (end == next || *end != after || number > kMaxSide_px) return std::nullopt;
    next = end + 1;
  }
  const auto [x, y, width, height] = numbers;
  if (std::max({x, y, width, height}) <= 1 && std::min(width, height) > 0) {
    area.kind = AreaSetting::Kind::kFractions;
    area.fractions = numbers;
    return area;
  }
  area.kind = AreaSetting::Kind::kFixed;
  area.part = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(width),
               static_cast<int>(height)};
  const bool is_whole = std::all_of(numbers.begin(), numbers.end(),
                                    [](double number) { return number == std::floor(number); });
  if (!is_whole || std::min(width, height) < kMinSide_px) return std::nullopt;
  return area;
}

std::string text_of(const AreaSetting& area) {
  if (area.kind == AreaSetting::Kind::kWhole) return "whole";
  if (area.kind == AreaSetting::Kind::kAuto) return "auto";
  const PicturePart& part = area.part;
  std::array<double, 4> numbers = area.fractions;
  if (area.kind == AreaSetting::Kind::kFixed) {
    numbers = {double(part.x), double(part.y), double(part.width), double(part.height)};
  }
  std::string text;
  for (const double number : numbers) {
    char digits[G_ASCII_DTOSTR_BUF_SIZE];
    text += (text.empty() ? "" : ",") +
            std::string(g_ascii_formatd(digits, sizeof digits, "%g", number));
  }
  return text;
}

}  // namespace spidar
