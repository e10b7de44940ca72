// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/reasons/no_force.h"

#include <algorithm>
#include <iterator>

#include "core/force/gain_controller.h"
#include "core/force/motion_rendering.h"
#include "core/motion/cadence.h"

namespace spidar {
namespace {

struct Wording {
  NoForceReason reason;
  const char* nick;
  const char* sentence;
};

/// In the order of the enumeration.
constexpr Wording kWordings[] = {
    {NoForceReason::kNone, "none", ""},
    {NoForceReason::kDeviceLost, "device-lost",
     "The device does not answer. The force returns when it does."},
    {NoForceReason::kDeviceStarting, "device-starting",
     "The device is not running yet: its strings are being tightened."},
    {NoForceReason::kGripUnknown, "grip-unknown",
     "The device is at rest because of a fault: the position of the grip is not known."},
    {NoForceReason::kGripReleased, "grip-released",
     "Nobody holds the grip: it moved, spun or rested as only a released one does. The force "
     "returns by itself."},
    {NoForceReason::kVibration, "vibration",
     "The force is lowered because it has shaken the hand for long: a day's vibration is limited. "
     "Calm scenes are felt as before, and the force returns with time."},
    {NoForceReason::kMuted, "muted", "The force is muted (mute=true)."},
    {NoForceReason::kNotPlaying, "not-playing",
     "The video is not playing: it is paused, it is seeking, or its clock stands still."},
    {NoForceReason::kEnded, "ended", "The film has ended."},
    {NoForceReason::kNoFrames, "no-frames",
     "No frame was measured in the last second: the video stalls, or its frames cannot be "
     "analysed, as a warning says."},
    {NoForceReason::kNothingToCompare, "nothing-to-compare",
     "There was nothing to compare a picture with: it is the first one, or each picture shows "
     "another scene."},
    {NoForceReason::kRepeatedFrames, "repeated-frames",
     "All frames of the last second show the same picture."},
    {NoForceReason::kFewPictures, "few-pictures",
     "The pictures come too seldom, less than six a second: hardly any motion can be followed from "
     "one to the next."},
    {NoForceReason::kTooFewPoints, "too-few-points",
     "The picture has too little texture to measure motion by."},
    {NoForceReason::kNotChosen, "not-chosen",
     "By what was chosen (feel, or a click with pointer=mouse), nothing is felt now: the rule says "
     "so, or its object is not in sight."},
    {NoForceReason::kAreaUnknown, "area-unknown",
     "What is around the film moves, or has just changed: it is not known where the film is. With "
     "area=whole, all of the picture is the film."},
    {NoForceReason::kNoFilm, "no-film",
     "There is no film in the picture: it shows a page that has scrolled, and nothing in it "
     "changes as "
     "a film does. With area=whole, all of the picture is the film."},
    {NoForceReason::kCameraUnknown, "camera-unknown",
     "How the camera moves cannot be told: no motion explains more than a small part of the "
     "picture. What moves against the background is therefore unknown, too."},
    {NoForceReason::kCameraOnly, "camera-only",
     "Only the camera moves, and motion=object and motion=objects leave that out; with "
     "motion=camera it is felt."},
    {NoForceReason::kObjectsOnly, "objects-only",
     "The camera rests and only objects move, which motion=camera leaves out; with motion=object "
     "they are felt."},
    {NoForceReason::kNothingMoves, "nothing-moves", "Nothing moves in the picture."},
    {NoForceReason::kTooWeak, "too-weak",
     "The force is weaker than a hand feels (0.04 N): the motion is slow, or alpha, depth-gain, "
     "roll-gain, max-force or, with touch, motion-fraction is small."},
    {NoForceReason::kSilentTrack, "silent-track",
     "The haptic track has no force here, or less than a hand feels (0.04 N)."},
    {NoForceReason::kCannotTouch, "cannot-touch",
     "This device cannot touch the picture: it gives no force towards the viewer, or does not "
     "measure how far the grip is from the picture. With touch=off the motion of the video is "
     "felt."},
    {NoForceReason::kNoRelief, "no-relief",
     "There is no surface to touch: no frame with a relief is on the screen, or the video has "
     "ended. With touch=depth, frames need depth."},
    {NoForceReason::kNotTouching, "not-touching",
     "The grip does not touch the surface: it is in front of it. Push it away from you, into the "
     "picture."},
    {NoForceReason::kLightTouch, "light-touch",
     "The grip touches the surface, but the force is weaker than a hand feels (0.04 N): press "
     "deeper, or touch-stiffness or max-force is small."},
    {NoForceReason::kLate, "late",
     "The frames come too late: their force is known only after they should have been shown."},
    {NoForceReason::kNoDevice, "no-device",
     "No device is open: device=none was set, or a warning has said why the device gives no "
     "force."},
};

constexpr bool is_in_order() {
  for (size_t i = 0; i < kNoForceReasons; ++i) {
    if (kWordings[i].reason != static_cast<NoForceReason>(i)) return false;
  }
  return std::size(kWordings) == kNoForceReasons;
}
static_assert(is_in_order());

/// A slower motion, in px/s of a frame 480 lines high, does not count: half of 2.1 px/s, whose
/// force a hand just feels with an alpha of 0.01 s/px (docs/feeling.md).
constexpr double kMoving_px_s = 1;
/// With fewer points, no motion can differ from the background's: one point is needed for a
/// translation of the background, and two for an object.
constexpr int kFewestPoints = 4;
/// When a hand swings a slack string, the pose is lost for less than this.
constexpr int64_t kGripLost_ns = 100'000'000;

bool is_withheld(const Frame& frame) {
  const Chosen& choice = frame.choice;
  if (choice.is_free()) return false;
  const bool is_one = choice.is_kept || choice.rule->kind == FeelRule::Kind::kObjectAt ||
                      choice.rule->kind == FeelRule::Kind::kBox;
  if (is_one) return frame.felt_object == 0;
  return choice.rule->kind == FeelRule::Kind::kNothing || choice.rule->gain == 0;
}

/// Whether a visible object moves by more than its error. motion=mean knows no objects.
bool objects_move(const Frame& frame) {
  return std::any_of(frame.objects.begin(), frame.objects.end(), [](const MovingObject& object) {
    return object.points > 0 && object.relative_px_s.norm() > object.error_px_s;
  });
}

/// Whether nothing was felt for kWindow_ns and the loop has no wrench for this moment.
bool is_late(const LoopSnapshot& loop) {
  return loop.unfelt_ns >= NoForceHistory::kWindow_ns &&
         (loop.last.found == Found::kExpired || loop.last.found == Found::kNothing);
}

}  // namespace

const char* nick(NoForceReason reason) noexcept {
  return kWordings[static_cast<size_t>(reason)].nick;
}

const char* sentence(NoForceReason reason) noexcept {
  return kWordings[static_cast<size_t>(reason)].sentence;
}

std::optional<NoForceReason> no_force_reason(std::string_view nick) noexcept {
  const Wording* const found =
      std::find_if(std::begin(kWordings), std::end(kWordings),
                   [nick](const Wording& wording) { return wording.nick == nick; });
  if (found == std::end(kWordings)) return std::nullopt;
  return found->reason;
}

NoForceReason reason_in_frame(const Frame& frame, MotionKind motion) {
  if (!frame.place.is_known) {
    return frame.place.is_page ? NoForceReason::kNoFilm : NoForceReason::kAreaUnknown;
  }
  if (frame.picture == FrameComparison::kFirst) return NoForceReason::kNothingToCompare;
  if (size_N(frame.wrench) >= kFeltForce_N) return NoForceReason::kNone;
  if (is_again(frame.picture)) return NoForceReason::kRepeatedFrames;
  if (is_withheld(frame)) return NoForceReason::kNotChosen;
  if (frame.shown_height_px > 0 &&
      reference_speeds_px_s(frame.motion, {}, frame.shown_height_px).norm() >= kMoving_px_s) {
    return NoForceReason::kTooWeak;
  }
  if (frame.interval_ns > Cadence::kLongest_ns) return NoForceReason::kFewPictures;
  if (frame.features < kFewestPoints) return NoForceReason::kTooFewPoints;
  const bool leaves_out_camera =
      frame.choice.is_free() ? motion == MotionKind::kObject || motion == MotionKind::kObjects
                             : frame.choice.is_kept || frame.choice.rule->is_about_objects();
  const bool is_unknown = frame.background && !frame.background->is_known;
  if (leaves_out_camera && is_unknown) return NoForceReason::kCameraUnknown;
  const bool camera_moves = frame.background && frame.background->model.kind != ModelKind::kStill;
  if (leaves_out_camera && camera_moves) return NoForceReason::kCameraOnly;
  return !leaves_out_camera && objects_move(frame) ? NoForceReason::kObjectsOnly
                                                   : NoForceReason::kNothingMoves;
}

NoForceReason reason_in_track(const Wrench& wrench, const std::optional<LoopSnapshot>& loop) {
  if (size_N(wrench) < kFeltForce_N) return NoForceReason::kSilentTrack;
  // Before its first tick the loop has no limit to report.
  const bool is_weak = loop && loop->counters.ticks > 0 && loop->last.max_force_N < kFeltForce_N;
  return is_weak ? NoForceReason::kTooWeak : NoForceReason::kNone;
}

NoForceReason reason_in_device(const LoopSnapshot& loop, bool muted) {
  switch (loop.last.device) {
    case DeviceState::kLost:
      return NoForceReason::kDeviceLost;
    case DeviceState::kOpening:
    case DeviceState::kClosing:
    case DeviceState::kClosed:
      return NoForceReason::kDeviceStarting;
    case DeviceState::kRunning:
    case DeviceState::kIdle:
      break;
  }
  if (loop.untrusted_ns > kGripLost_ns) return NoForceReason::kGripUnknown;
  if (muted) return NoForceReason::kMuted;
  if (!loop.last.playing) return NoForceReason::kNotPlaying;
  if (!loop.last.held) return NoForceReason::kGripReleased;
  return loop.vibration.lowered() ? NoForceReason::kVibration : NoForceReason::kNone;
}

NoForceReason reason_in_contact(const LoopSnapshot& loop, bool can_touch) {
  if (loop.unfelt_ns < NoForceHistory::kWindow_ns) return NoForceReason::kNone;
  if (!can_touch) return NoForceReason::kCannotTouch;
  const touch::Contact& contact = loop.last.contact;
  if (!contact.has_surface) return NoForceReason::kNoRelief;
  return contact.touching ? NoForceReason::kLightTouch : NoForceReason::kNotTouching;
}

void NoForceHistory::add(int64_t shown_ns, double force_N, NoForceReason reason) noexcept {
  if (count_ > 0 && shown_ns <= latest(0).shown_ns) reset();
  frames_[next_] = {shown_ns, force_N, reason};
  next_ = (next_ + 1) % kFrames;
  count_ = std::min(count_ + 1, kFrames);
}

NoForceReason NoForceHistory::reason(int64_t now_ns) const noexcept {
  std::array<size_t, kNoForceReasons> pictures{};
  bool repeats = false;
  for (size_t i = 0; i < count_; ++i) {
    const Shown& frame = latest(i);
    if (frame.shown_ns > now_ns) continue;
    if (frame.shown_ns <= now_ns - kWindow_ns) break;
    if (frame.force_N >= kFeltForce_N) return NoForceReason::kNone;
    if (frame.reason == NoForceReason::kRepeatedFrames) {
      repeats = true;
    } else {
      ++pictures[static_cast<size_t>(frame.reason)];
    }
  }
  // Pictures without a comparison count only if there are no others.
  size_t& incomparable = pictures[static_cast<size_t>(NoForceReason::kNothingToCompare)];
  const bool any_incomparable = incomparable > 0;
  incomparable = 0;
  const auto most = std::max_element(pictures.begin(), pictures.end());
  if (*most > 0) return static_cast<NoForceReason>(most - pictures.begin());
  if (repeats) return NoForceReason::kRepeatedFrames;
  return any_incomparable ? NoForceReason::kNothingToCompare : NoForceReason::kNoFrames;
}

void NoForceWatch::add(int64_t shown_ns, const Wrench& wrench, NoForceReason reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  frames_.add(shown_ns, size_N(wrench), reason);
  newest_ns_ = shown_ns;
  is_last_ = false;
}

void NoForceWatch::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_last_ = true;
}

void NoForceWatch::reset() {
  const std::lock_guard<std::mutex> lock(mutex_);
  frames_.reset();
  newest_ns_ = 0;
  is_last_ = false;
}

NoForceReason NoForceWatch::film(const std::optional<LoopSnapshot>& loop) const {
  // Running time is 0 while the loop does not play.
  return frames_.reason(loop && loop->last.playing ? loop->last.running_ns : newest_ns_);
}

/// Whether the last frame is on the screen. Without a device, that moment is unknown.
bool NoForceWatch::has_ended(const std::optional<LoopSnapshot>& loop) const {
  return is_last_ && (!loop || loop->last.running_ns >= newest_ns_);
}

NoForceReason NoForceWatch::device(const std::optional<LoopSnapshot>& loop) const {
  if (!loop) return NoForceReason::kNoDevice;
  const NoForceReason reason = reason_in_device(*loop, muted_);
  const bool is_at_rest = reason == NoForceReason::kNone || reason == NoForceReason::kNotPlaying;
  if (is_at_rest && has_ended(loop)) return NoForceReason::kEnded;
  if (reason != NoForceReason::kNone) return reason;
  if (touching_) return reason_in_contact(*loop, can_touch_);
  // When frames come too late, perhaps none is due in the last second.
  const int64_t due_ns = std::min(newest_ns_, loop->last.running_ns);
  const bool was_due = frames_.reason(due_ns) == NoForceReason::kNone;
  return was_due && is_late(*loop) ? NoForceReason::kLate : NoForceReason::kNone;
}

NoForceReason NoForceWatch::of_film(const std::optional<LoopSnapshot>& loop) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return film(loop);
}

NoForceReason NoForceWatch::of_device(const std::optional<LoopSnapshot>& loop) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return device(loop);
}

NoForceReason NoForceWatch::first(const std::optional<LoopSnapshot>& loop) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (has_ended(loop)) return NoForceReason::kEnded;
  const NoForceReason of_device = device(loop);
  if (touching_) return of_device;
  const NoForceReason of_film = film(loop);
  // The lack of frames may be due to the device.
  const bool has_own = of_film != NoForceReason::kNone && of_film != NoForceReason::kNoFrames;
  return has_own || of_device == NoForceReason::kNone ? of_film : of_device;
}

}  // namespace spidar
