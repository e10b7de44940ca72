// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/element/watched_memory.h"

#include <cstring>

namespace {

struct WatchedMemory {
  GstMemory parent;
  gpointer data;
  spidar::test::MemoryUse* use;
};

WatchedMemory* watched(GstMemory* memory) {
  return reinterpret_cast<WatchedMemory*>(memory);
}

gpointer map(GstMemory* memory, gsize, GstMapFlags flags) {
  ++((flags & GST_MAP_WRITE) != 0 ? watched(memory)->use->writes : watched(memory)->use->reads);
  return watched(memory)->data;
}

void unmap(GstMemory*) {}

GstMemory* copy(GstMemory* memory, gssize offset, gssize size) {
  ++watched(memory)->use->copies;
  const gsize begin = memory->offset + static_cast<gsize>(offset);
  const gsize length =
      size < 0 ? memory->size - static_cast<gsize>(offset) : static_cast<gsize>(size);
  GstMemory* made = gst_allocator_alloc(nullptr, length, nullptr);
  GstMapInfo to;
  gst_memory_map(made, &to, GST_MAP_WRITE);
  std::memcpy(to.data, static_cast<guint8*>(watched(memory)->data) + begin, length);
  gst_memory_unmap(made, &to);
  return made;
}

}  // namespace

typedef GstAllocator GstWatchedAllocator;
typedef GstAllocatorClass GstWatchedAllocatorClass;
G_DEFINE_TYPE(GstWatchedAllocator, gst_watched_allocator, GST_TYPE_ALLOCATOR)

static void gst_watched_allocator_class_init(GstWatchedAllocatorClass* klass) {
  klass->free = [](GstAllocator*, GstMemory* memory) {
    g_free(watched(memory)->data);
    delete watched(memory);
  };
}

static void gst_watched_allocator_init(GstWatchedAllocator* allocator) {
  allocator->mem_type = "watched";
  allocator->mem_map = map;
  allocator->mem_unmap = unmap;
  allocator->mem_copy = copy;
  GST_OBJECT_FLAG_SET(allocator, GST_ALLOCATOR_FLAG_CUSTOM_ALLOC);
}

GstMemory* spidar::test::new_watched_memory(gsize size, MemoryUse& use) {
  GstAllocator* allocator = GST_ALLOCATOR(g_object_new(gst_watched_allocator_get_type(), nullptr));
  gst_object_ref_sink(allocator);
  // Not shareable: a copy of the buffer would copy the memory, and be counted.
  auto* memory = new WatchedMemory{{}, g_malloc0(size), &use};
  gst_memory_init(GST_MEMORY_CAST(memory), GST_MEMORY_FLAG_NO_SHARE, allocator, nullptr, size, 0, 0,
                  size);
  gst_object_unref(allocator);  // the memory holds it
  return GST_MEMORY_CAST(memory);
}
