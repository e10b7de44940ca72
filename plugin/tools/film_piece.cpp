// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_piece.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "plugin/gobject/pads.h"

namespace spidar {
namespace {

std::optional<int64_t> stream_ns_of(GstPad* pad, GstBuffer* frame) {
  const GstClockTime time = stream_time_of(pad, frame);
  if (!GST_CLOCK_TIME_IS_VALID(time)) return {};
  return static_cast<int64_t>(time);
}

/// Much longer than it takes to seek on a slow share.
constexpr std::chrono::seconds kLongestSeek{60};
constexpr const char* kNoMiddle =
    "it cannot be read from its middle, and has to be measured in one piece";

constexpr auto kFrames =
    static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_EVENT_FLUSH);

}  // namespace

void FilmPiece::set_film(int64_t film_ns) {
  if (film_ns <= 0) {
    throw std::runtime_error("it does not say how long it is, and has to be measured in one piece");
  }
  piece_.film_ns = film_ns;
  end_.emplace(piece_);
  target_ns_ = begin_ns(piece_);
  if (target_ns_ == 0) stage_ = Stage::kThere;
}

void FilmPiece::begin(GstElement* pipeline, const RecordProperties& properties) {
  GstElement* motion = gst_bin_get_by_name(GST_BIN(pipeline), "motion");
  GstPad* in = gst_element_get_static_pad(motion, "sink");
  GstPad* out = gst_element_get_static_pad(motion, "src");
  messages_.listen(pipeline, motion);
  if (piece_.number < piece_.of) second_.emplace(pipeline, properties);
  gst_pad_add_probe(in, kFrames, comes, this, nullptr);
  gst_pad_add_probe(out, GST_PAD_PROBE_TYPE_BUFFER, passes, this, nullptr);
  gst_object_unref(out);
  gst_object_unref(in);
  gst_object_unref(motion);
}

MotionPiece FilmPiece::found() const {
  const std::lock_guard<std::mutex> lock(lock_);
  MotionPiece piece = piece_;
  piece.has_end = !has_ended_;
  return piece;
}

bool FilmPiece::is_empty() const {
  const std::lock_guard<std::mutex> lock(lock_);
  return end_->is_empty();
}

GstPadProbeReturn FilmPiece::comes(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
  auto& self = *static_cast<FilmPiece*>(user);
  if (info->type & GST_PAD_PROBE_TYPE_BUFFER) {
    if (self.is_wanted(stream_ns_of(pad, GST_PAD_PROBE_INFO_BUFFER(info)))) return GST_PAD_PROBE_OK;
    self.await_seek(pad);
    return GST_PAD_PROBE_DROP;
  }
  const std::lock_guard<std::mutex> lock(self.lock_);
  if (self.stage_ == Stage::kSeeking) self.stage_ = Stage::kSought;
  self.changed_.notify_all();
  return GST_PAD_PROBE_OK;
}

/// Whether a frame belongs to the piece. A demuxer without an index may come out behind its
/// beginning: then it is sought somewhat earlier.
bool FilmPiece::is_wanted(std::optional<int64_t> stream_ns) {
  const std::lock_guard<std::mutex> lock(lock_);
  if (has_ended_ || stage_ == Stage::kBegin || stage_ == Stage::kSeeking) return false;
  if (!stream_ns) return stage_ == Stage::kThere;
  const bool is_before = end_->part_of(*stream_ns) < piece_.number;
  if (stage_ == Stage::kThere) return !is_before;
  if (!is_before && *stream_ns > begin_ns(piece_) && target_ns_ > 0) {
    target_ns_ = std::max<int64_t>(0, target_ns_ - earlier_ns_);
    earlier_ns_ *= 2;
    stage_ = Stage::kBegin;
    return false;
  }
  stage_ = Stage::kThere;
  return !is_before;
}

/// Where a seek is wanted, begins it, and waits until it has made the frames obsolete that come
/// until then.
void FilmPiece::await_seek(GstPad* pad) {
  GstElement* motion = gst_pad_get_parent_element(pad);
  std::unique_lock<std::mutex> lock(lock_);
  if (stage_ == Stage::kBegin) {
    stage_ = Stage::kSeeking;
    gst_element_call_async(motion, seek, this, nullptr);
  }
  const auto is_over = [this] { return stage_ != Stage::kSeeking || has_ended_; };
  const bool in_time = changed_.wait_for(lock, kLongestSeek, is_over);
  lock.unlock();
  if (!in_time) GST_ELEMENT_ERROR(motion, STREAM, FAILED, ("%s", kNoMiddle), (nullptr));
  gst_object_unref(motion);
}

/// In a thread of its own, because the thread of the frames must not wait for itself.
void FilmPiece::seek(GstElement* motion, gpointer user) {
  auto& self = *static_cast<FilmPiece*>(user);
  GstPad* in = gst_element_get_static_pad(motion, "sink");
  GstEvent* const event =
      gst_event_new_seek(1, GST_FORMAT_TIME,
                         static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_KEY_UNIT |
                                                   GST_SEEK_FLAG_SNAP_BEFORE),
                         GST_SEEK_TYPE_SET, self.target_ns_, GST_SEEK_TYPE_NONE, 0);
  if (!gst_pad_push_event(in, event)) {
    GST_ELEMENT_ERROR(motion, STREAM, FAILED, ("%s", kNoMiddle), (nullptr));
    const std::lock_guard<std::mutex> lock(self.lock_);
    self.has_ended_ = true;
    self.changed_.notify_all();
  }
  gst_object_unref(in);
}

/// Whether no frame after this one is needed.
bool FilmPiece::is_last(GstPad* pad, GstBuffer* frame) {
  const std::optional<int64_t> stream_ns = stream_ns_of(pad, frame);
  const std::optional<FoundFrame> found = messages_.take(frame);
  if (!stream_ns) return false;
  const int part = end_->part_of(*stream_ns);
  const bool is_own = part <= piece_.number;
  bool agrees = is_own;
  if (!is_own && second_) agrees = second_->measure(pad, frame, part) == found;
  if (!found) return false;
  return end_->take(found->shown, *stream_ns, agrees);
}

GstPadProbeReturn FilmPiece::passes(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
  auto& self = *static_cast<FilmPiece*>(user);
  if (!self.is_last(pad, GST_PAD_PROBE_INFO_BUFFER(info))) return GST_PAD_PROBE_OK;
  {
    const std::lock_guard<std::mutex> lock(self.lock_);
    self.has_ended_ = true;
  }
  gst_pad_push_event(pad, gst_event_new_eos());
  return GST_PAD_PROBE_DROP;
}

}  // namespace spidar
