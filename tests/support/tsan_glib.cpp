// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// GLib's locks and references, as the thread sanitizer has to see them.
//
// GLib and GStreamer are not built with the sanitizer, and their mutexes are futexes of their own:
// what one thread did before it unlocked would look unordered to what another does after it locked.
// The functions here stand before GLib's, call them, and tell the sanitizer what they order.
// Recursive and read-write locks are pthread's inside, which the sanitizer knows by itself.
// It is to be run with ignore_noninstrumented_modules=1: code that it cannot see is not judged.
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
