// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/guarded_frame.h"

#include <cstdlib>
#include <sys/mman.h>
#include <unistd.h>

#include "tests/support/video_formats.h"

namespace spidar::test {
namespace {

struct Mapping {
  void* begin;
  size_t size;
};

void unmap(gpointer user) {
  auto* mapping = static_cast<Mapping*>(user);
  munmap(mapping->begin, mapping->size);
  delete mapping;
}

/// `size` bytes of noise next to a page without access.
GstMemory* guarded_memory(size_t size, bool guard_in_front, RandomSource& random) {
  const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
  const size_t inner = (size + page - 1) / page * page;
  const size_t whole = inner + 2 * page;
  void* begin = mmap(nullptr, whole, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (begin == MAP_FAILED) std::abort();
  auto* usable = static_cast<uint8_t*>(begin) + page;
  if (mprotect(usable, inner, PROT_READ | PROT_WRITE) != 0) std::abort();
  uint8_t* data = guard_in_front ? usable : usable + inner - size;
  for (size_t i = 0; i < size; ++i) data[i] = static_cast<uint8_t>(random.below(256));
  return gst_memory_new_wrapped(static_cast<GstMemoryFlags>(0), data, size, 0, size,
                                new Mapping{begin, whole}, unmap);
}

/// The bytes of a line of a plane, without padding.
int line_bytes(const GstVideoInfo& info, guint plane) {
  for (guint c = 0; c < GST_VIDEO_INFO_N_COMPONENTS(&info); ++c) {
    if (static_cast<guint>(GST_VIDEO_INFO_COMP_PLANE(&info, c)) == plane)
      return GST_VIDEO_INFO_COMP_WIDTH(&info, c) * GST_VIDEO_INFO_COMP_PSTRIDE(&info, c);
  }
  return 0;
}

int plane_lines(const GstVideoInfo& info, guint plane) {
  for (guint c = 0; c < GST_VIDEO_INFO_N_COMPONENTS(&info); ++c) {
    if (static_cast<guint>(GST_VIDEO_INFO_COMP_PLANE(&info, c)) == plane)
      return GST_VIDEO_INFO_COMP_HEIGHT(&info, c);
  }
  return 0;
}

/// The bytes from the first line of a plane to the end of its last.
size_t plane_bytes(const GstVideoInfo& info, const FrameLayout& layout, guint plane) {
  return static_cast<size_t>(layout.stride[plane] * (plane_lines(info, plane) - 1) +
                             line_bytes(info, plane));
}

void paint(const GstVideoInfo& info, const GreyPicture& picture, gint stride, guint8* first_line,
           RandomSource& random) {
  const int pixel = GST_VIDEO_INFO_COMP_PSTRIDE(&info, 0);
  // In packed colours, red, green and blue are components of plane 0; the others stay noise.
  for (guint c = 0; c < GST_VIDEO_INFO_N_COMPONENTS(&info); ++c) {
    const bool alpha = GST_VIDEO_INFO_HAS_ALPHA(&info) && c == 3;
    if (GST_VIDEO_INFO_COMP_PLANE(&info, c) != 0 || alpha) continue;
    const int offset = GST_VIDEO_INFO_COMP_POFFSET(&info, c);
    for (int y = 0; y < picture.height; ++y) {
      guint8* line = first_line + static_cast<ptrdiff_t>(stride) * y;
      for (int x = 0; x < picture.width; ++x) {
        write_sample(*info.finfo, c, picture.at(x, y), static_cast<guint>(random.below(256)),
                     line + x * pixel + offset);
      }
    }
  }
}

}  // namespace

FrameLayout random_layout(const GstVideoInfo& info, RandomSource& random) {
  FrameLayout layout;
  layout.planes = GST_VIDEO_INFO_N_PLANES(&info);
  layout.one_memory = random.chance(0.5);
  layout.guard_in_front = random.chance(0.3);
  for (guint p = 0; p < layout.planes; ++p) {
    const int padding = random.chance(0.3) ? 0 : static_cast<int>(random.below(70));
    layout.stride[p] = line_bytes(info, p) + padding;
    layout.before[p] = random.chance(0.5) ? 0 : random.below(100);
  }
  return layout;
}

GstBuffer* make_guarded_frame(const GstVideoInfo& info, const GreyPicture& picture,
                              const FrameLayout& layout, RandomSource& random) {
  GstBuffer* buffer = gst_buffer_new();
  gsize offset[GST_VIDEO_MAX_PLANES] = {};
  gsize size = 0;
  for (guint p = 0; p < layout.planes; ++p) {
    const gsize bytes = plane_bytes(info, layout, p);
    offset[p] = size + layout.before[p];
    if (!layout.one_memory) {
      gst_buffer_append_memory(
          buffer, guarded_memory(layout.before[p] + bytes, layout.guard_in_front, random));
    }
    size = offset[p] + bytes;
  }
  if (layout.one_memory)
    gst_buffer_append_memory(buffer, guarded_memory(size, layout.guard_in_front, random));

  GstMapInfo map;
  gst_buffer_map_range(buffer, 0, 1, &map, GST_MAP_WRITE);
  paint(info, picture, layout.stride[0], map.data + offset[0], random);
  gst_buffer_unmap(buffer, &map);
  gst_buffer_add_video_meta_full(buffer, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_INFO_FORMAT(&info),
                                 static_cast<guint>(GST_VIDEO_INFO_WIDTH(&info)),
                                 static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&info)), layout.planes,
                                 offset, const_cast<gint*>(layout.stride));
  return buffer;
}

}  // namespace spidar::test
