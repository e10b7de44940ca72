// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/frame_fields.h"

#include "core/motion/objects/moving_object.h"
#include "plugin/gobject/structure_fields.h"

namespace spidar {
namespace {

constexpr unsigned kEverywhere = kInMessage | kInMeta | kInCsv | kInJson;

constexpr const char* kAnalyzedArea =
    "part of the frame that was analysed ([area](../meta.md#the-films-area))";
constexpr const char* kFilmArea =
    "[area](../meta.md#the-films-area) of the film, to which all other lengths refer";

uint32_t to_unsigned(int number) {
  return static_cast<uint32_t>(number);
}

/// The error of the single object that is felt; 0 if there is none, or more than one.
double felt_error_px_s(const Frame& frame) {
  const MovingObject* const felt = find_object(frame.objects, frame.felt_object);
  return felt ? felt->error_px_s : 0;
}

void motion_fields(const ImageMotion& motion, FieldSink& to) {
  to.begin("motion");
  to.in(kInMessage | kInCsv | kInJson, "tracked", "", to_unsigned(motion.tracked),
        "points or blocks that the motion is measured with");
  to.in(kEverywhere, "velocity", "px/s", axes(motion.velocity_px_s),
        "velocity of the motion that becomes force, before the filter: x right, y down, in pixels "
        "of the frame");
  to.in(kInMeta | kInJson, "growth", "1/s", motion.growth_1_s,
        "relative change of lengths; positive when it comes nearer");
  to.in(kInMeta | kInJson, "roll", "rad/s", motion.roll_rad_s,
        "rotation, clockwise as seen by the viewer");
  to.end();
}

}  // namespace

void area_fields(const PicturePart& film, FieldSink& to) {
  to.in(kInMessage | kInMeta, "area-x", "px", to_unsigned(film.x), kAnalyzedArea);
  to.in(kInMessage | kInMeta, "area-y", "px", to_unsigned(film.y), kAnalyzedArea);
  to.in(kInMessage | kInMeta, "area-width", "px", to_unsigned(film.width), kAnalyzedArea);
  to.in(kInMessage | kInMeta, "area-height", "px", to_unsigned(film.height), kAnalyzedArea);
}

void no_force_fields(NoForceReason film, NoForceReason device, FieldSink& to) {
  to.in(kInMessage | kInCsv, "no-force-reason", "", nick(film),
        "why nothing of this frame is felt, in the film "
        "([Troubleshooting](../troubleshooting.md)), or `none`; in `stats`, of the last second");
  to.in(kInMessage, "no-force-text", "", sentence(film),
        "`no-force-reason` as a sentence; empty if that is `none`");
  to.in(kInMessage | kInCsv, "device-no-force-reason", "", nick(device),
        "why nothing is felt now, in the device or the playback, or `none`");
  to.in(kInMessage, "device-no-force-text", "", sentence(device),
        "the same of `device-no-force-reason`");
}

void frame_fields(const FrameReport& report, const FrameBuffer& buffer, FieldSink& to) {
  const Frame& frame = report.frame;
  to.in(kInMessage, "timestamp", "ns", buffer.timestamp, "timestamp of the frame's buffer");
  to.in(kInMeta, "width", "px", buffer.width, "size of the frame that lengths refer to");
  to.in(kInMeta, "height", "px", buffer.height, "the same");
  to.in(kEverywhere, "running-time", "ns", report.stamp.running_ns, "when the frame is due");
  to.in(kInMessage | kInCsv | kInJson, "stream-time", "ns", report.stamp.stream_ns,
        "position of the frame in the film");
  to.in(kInMessage, "duration", "ns", buffer.duration, "duration of the frame's buffer");
  to.in(kInMeta | kInJson, "interval", "ns", frame.interval_ns,
        "time since the frame that it was compared with, or 0");
  const PicturePart& area = frame.place.area;
  to.in(kInJson, "left", "px", area.x, kFilmArea);
  to.in(kInJson, "top", "px", area.y, kFilmArea);
  to.in(kInJson, "width", "px", area.width, kFilmArea);
  to.in(kInJson, "height", "px", area.height, kFilmArea);
  to.in(kInJson, "restarted", "", frame.picture == FrameComparison::kFirst,
        "the analysis began anew with this frame");
  to.in(kInMessage | kInJson, "repeated", "", is_again(frame.picture),
        "the frame shows the previous picture again; the previous wrench remains valid");
  to.in(kInMeta, "repeated", "", frame.is_continuation(), "the previous wrench remains valid");
  to.in(kInMessage | kInCsv | kInJson, "features", "", to_unsigned(frame.features),
        "points that are followed from this frame on");
  motion_fields(frame.motion, to);
  to.begin("wrench");
  to.in(kEverywhere, "force", "N", axes(frame.wrench.force_N),
        "wanted force, before any limit: x right, y up, z towards the viewer");
  to.in(kEverywhere, "torque", "N m", axes(frame.wrench.torque_Nm),
        "wanted torque about these axes");
  to.end();
  to.in(kInMessage, "velocity-error", "px/s", felt_error_px_s(frame),
        "[bound](../tracking.md#bound-of-the-error) of its error in 95 % of the frames; 0 if it is "
        "not that of one object");
  to.in(kInMessage | kInJson, "object", "", frame.felt_object,
        "id of the one object that is felt; 0 if it is none, or not one alone");
  to.in(kInMessage, "track", "", report.track ? report.track->c_str() : "",
        "file of the haptic track whose force this is; empty if the frame was analysed. With a "
        "track, features, tracked, velocities and object are 0");
  area_fields(report.film_part(), to);
  no_force_fields(report.no_force, report.device_no_force, to);
}

void background_fields(const Background& background, FieldSink& to) {
  const MotionModel& model = background.model;
  to("model", "", to_string(model.kind), "as `model` in `stats`");
  to("shift", "px", axes(model.shift_px), "its shift since the previous frame");
  to("linear", "", Eigen::MatrixXd(model.linear), "its linear part, a matrix: identity is zero");
  to("perspective", "1/px", axes(model.perspective_1_px), "its perspective part");
  to("sigma", "px", background.sigma_px, "standard deviation of the blocks that follow it");
  to("coverage", "", background.coverage, "fraction of the film that follows it");
}

void object_fields(const MovingObject& object, FieldSink& to) {
  to("id", "", object.id, "the same from frame to frame");
  to("position", "px", axes(object.position_px), "middle of its box, from the middle of the film");
  to("size", "px", axes(object.size_px), "width and height of its box");
  to("velocity", "px/s", axes(object.relative_px_s), "velocity against the background");
  to("error", "px/s", object.error_px_s, "its error, as `velocity-error` in the message");
  to("on-screen", "px/s", axes(object.on_screen_px_s), "velocity on the screen");
  to("growth", "1/s", object.growth_1_s, "as those of `motion`");
  to("roll", "rad/s", object.roll_rad_s, "as those of `motion`");
  to("model", "", to_string(object.model), "model of its motion");
  to("points", "", to_unsigned(object.points), "points and blocks of it");
  to("prominence", "", object.prominence,
     "how likely a viewer watches it; the largest is the dominant object");
}

void post_motion_message(GstElement* element, GstClockTime timestamp, GstClockTime duration,
                         const FrameReport& report, UnreadMessages& unread) {
  unread.post(element, [&] {
    GstStructure* const structure = gst_structure_new_empty("spidar-motion");
    StructureFields to(structure, kInMessage);
    frame_fields(report, {timestamp, duration}, to);
    return gst_message_new_element(GST_OBJECT(element), structure);
  });
}

}  // namespace spidar
