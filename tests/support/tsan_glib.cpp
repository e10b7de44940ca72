// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Tells the thread sanitizer about GLib's locks and references.
//
// GLib and GStreamer are not built with the sanitizer, and their mutexes are futexes of their own.
// The accesses of one thread before it unlocks would therefore seem unordered with those of another
// thread after it locks. The functions here replace GLib's: they call them and report the order to
// the sanitizer. Recursive and read-write locks use pthread, which the sanitizer knows. Run it with
// ignore_noninstrumented_modules=1, so that code that it cannot see is not judged.
#include <dlfcn.h>
#include <sanitizer/tsan_interface.h>

#include <glib-object.h>

namespace {

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// GLib's function of that name, looked up once.
#define GLIBS(function) static const auto glibs = next<decltype(&function)>(#function);

extern "C" {

void g_mutex_lock(GMutex* mutex) {
  GLIBS(g_mutex_lock)
  glibs(mutex);
  __tsan_acquire(mutex);
}

gboolean g_mutex_trylock(GMutex* mutex) {
  GLIBS(g_mutex_trylock)
  const gboolean locked = glibs(mutex);
  if (locked) __tsan_acquire(mutex);
  return locked;
}

void g_mutex_unlock(GMutex* mutex) {
  GLIBS(g_mutex_unlock)
  __tsan_release(mutex);
  glibs(mutex);
}

void g_cond_wait(GCond* condition, GMutex* mutex) {
  GLIBS(g_cond_wait)
  __tsan_release(mutex);
  glibs(condition, mutex);
  __tsan_acquire(mutex);
}

gboolean g_cond_wait_until(GCond* condition, GMutex* mutex, gint64 end_time) {
  GLIBS(g_cond_wait_until)
  __tsan_release(mutex);
  const gboolean signalled = glibs(condition, mutex, end_time);
  __tsan_acquire(mutex);
  return signalled;
}

// Whoever gives up the last reference destroys what others used before they gave up theirs.
void g_object_unref(gpointer object) {
  GLIBS(g_object_unref)
  __tsan_release(object);
  __tsan_acquire(object);
  glibs(object);
}

}  // extern "C"
