// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/shared_picture.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace spidar {
namespace {

bool read_caps(const std::string& text, GstVideoInfo& info) {
  GstCaps* const caps = gst_caps_from_string(text.c_str());
  if (!caps) return false;
  const bool is_read = gst_caps_is_fixed(caps) && gst_video_info_from_caps(&info, caps);
  gst_caps_unref(caps);
  return is_read;
}

}  // namespace

MappedPictures::MappedPictures(const PictureMemory& description, int file)
    : description_(description) {
  gst_video_info_init(&info_);
  struct stat status {};
  // No overflow: a file is shorter than 2^63 bytes, and there are few slots.
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

}  // namespace spidar
