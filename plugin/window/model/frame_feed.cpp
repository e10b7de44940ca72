// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/model/frame_feed.h"

#include <utility>

namespace spidar {

PictureCopy::~PictureCopy() {
  gst_clear_buffer(&buffer_);
}

void swap(PictureCopy& a, PictureCopy& b) noexcept {
  std::swap(a.info_, b.info_);
  std::swap(a.buffer_, b.buffer_);
}

bool PictureCopy::copy(const GstVideoFrame& frame) {
  const GstVideoInfo& given = frame.info;
  GstVideoInfo own;
  if (!gst_video_info_set_format(&own, GST_VIDEO_INFO_FORMAT(&given),
                                 static_cast<guint>(GST_VIDEO_INFO_WIDTH(&given)),
                                 static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&given)))) {
    return false;
  }
  own.colorimetry = given.colorimetry;
  own.chroma_site = given.chroma_site;
  own.par_n = given.par_n;
  own.par_d = given.par_d;
  if (buffer_ && !gst_video_info_is_equal(&own, &info_)) gst_clear_buffer(&buffer_);
  if (!buffer_) buffer_ = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&own), nullptr);
  info_ = own;
  GstVideoFrame target;
  if (!buffer_ || !gst_video_frame_map(&target, &info_, buffer_, GST_MAP_WRITE)) return false;
  const bool copied = gst_video_frame_copy(&target, &frame);
  gst_video_frame_unmap(&target);
  return copied;
}

bool FrameFeed::give(const GstVideoFrame& frame, const FrameFacts& facts) {
  if (!back_) back_ = std::make_unique<Entry>();
  if (!back_->picture.copy(frame)) return false;
  back_->facts = facts;
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return false;
  ready_.push_back(std::move(back_));
  if (ready_.size() > kMost) {
    spare_ = std::move(ready_.front());
    ready_.pop_front();
  }
  back_ = std::move(spare_);
  const size_t wanted = wanted_.load(std::memory_order_relaxed);
  if (wanted > 0) wanted_.store(wanted - 1, std::memory_order_release);
  return true;
}

bool FrameFeed::take(PictureCopy& picture, FrameFacts& facts) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (ready_.empty()) return false;
  spare_ = std::move(ready_.front());
  ready_.pop_front();
  swap(picture, spare_->picture);
  std::swap(facts, spare_->facts);
  return true;
}

}  // namespace spidar
