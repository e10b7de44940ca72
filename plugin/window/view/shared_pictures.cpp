// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/view/shared_pictures.h"

#include <algorithm>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "plugin/gobject/ref.h"

namespace spidar::window {
namespace {

/// The same format and size without padding.
GstVideoInfo plain_info(const GstVideoInfo& given) {
  GstVideoInfo plain;
  gst_video_info_init(&plain);
  gst_video_info_set_format(&plain, GST_VIDEO_INFO_FORMAT(&given),
                            static_cast<guint>(GST_VIDEO_INFO_WIDTH(&given)),
                            static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&given)));
  plain.colorimetry = given.colorimetry;
  plain.chroma_site = given.chroma_site;
  plain.par_n = given.par_n;
  plain.par_d = given.par_d;
  return plain;
}

std::string caps_text(const GstVideoInfo& info) {
  const Ref<GstCaps> caps(gst_video_info_to_caps(&info));
  return taken(gst_caps_to_string(caps.get()));
}

bool read_caps(const std::string& text, GstVideoInfo& info) {
  const Ref<GstCaps> caps(gst_caps_from_string(text.c_str()));
  return caps && gst_caps_is_fixed(caps.get()) && gst_video_info_from_caps(&info, caps.get());
}

}  // namespace

PictureSlots::PictureSlots(uint32_t id, const GstVideoFrame& frame)
    : info_(plain_info(frame.info)), taken_(kSlots, false) {
  description_ = {id, caps_text(info_), kSlots, GST_VIDEO_INFO_SIZE(&info_)};
  const size_t bytes = size_t{kSlots} * GST_VIDEO_INFO_SIZE(&info_);
  file_ = memfd_create("spidar-window", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  // The seals fix the size: otherwise, reading beyond the end of a shorter file kills the window.
  if (file_ < 0 || ftruncate(file_, static_cast<off_t>(bytes)) != 0 ||
      fcntl(file_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) {
    return;
  }
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (memory != MAP_FAILED) memory_ = static_cast<uint8_t*>(memory);
}

PictureSlots::~PictureSlots() {
  if (memory_) munmap(memory_, kSlots * description_.slot_bytes);
  if (file_ >= 0) ::close(file_);
}

bool PictureSlots::fits(const GstVideoFrame& frame) const {
  const GstVideoInfo plain = plain_info(frame.info);
  return gst_video_info_is_equal(&plain, &info_);
}

std::optional<uint32_t> PictureSlots::acquire() {
  const auto free = std::find(taken_.begin(), taken_.end(), false);
  if (free == taken_.end()) return std::nullopt;
  *free = true;
  return static_cast<uint32_t>(free - taken_.begin());
}

void PictureSlots::release(uint32_t slot) {
  if (slot < kSlots) taken_[slot] = false;
}

bool PictureSlots::copy(const GstVideoFrame& frame, uint32_t slot) const {
  const gsize bytes = description_.slot_bytes;
  const Ref<GstBuffer> buffer(gst_buffer_new_wrapped_full(
      GST_MEMORY_FLAG_NO_SHARE, memory_ + slot * bytes, bytes, 0, bytes, nullptr, nullptr));
  GstVideoFrame target;
  if (!gst_video_frame_map(&target, &info_, buffer.get(), GST_MAP_WRITE)) return false;
  const bool is_copied = gst_video_frame_copy(&target, &frame) != FALSE;
  gst_video_frame_unmap(&target);
  return is_copied;
}

MappedPictures::MappedPictures(const PictureMemory& description, int file)
    : description_(description) {
  gst_video_info_init(&info_);
  struct stat status {};
  // A file is shorter than 2^63 bytes, and there are few slots, so nothing overflows.
  const bool is_known =
      file >= 0 && fstat(file, &status) == 0 && status.st_size > 0 &&
      read_caps(description.caps, info_) && description.slots > 0 &&
      description.slot_bytes == GST_VIDEO_INFO_SIZE(&info_) &&
      description.slot_bytes <= static_cast<uint64_t>(status.st_size) / description.slots;
  if (is_known) {
    bytes_ = description.slots * description.slot_bytes;
    void* const memory = mmap(nullptr, bytes_, PROT_READ, MAP_SHARED, file, 0);
    if (memory != MAP_FAILED) memory_ = static_cast<const uint8_t*>(memory);
  }
  if (file >= 0) ::close(file);
}

MappedPictures::~MappedPictures() {
  if (memory_) munmap(const_cast<uint8_t*>(memory_), bytes_);
}

}  // namespace spidar::window
