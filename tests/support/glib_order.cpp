// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Tells the thread sanitizer how GLib's locks and reference counts order the work of threads. GLib
/// is not built with the sanitizer and makes its locks of futexes, so everything that they protect
/// would look like a race. A program that is linked with this file, and GStreamer's libraries in
/// it, call these functions instead of GLib's.
#include <dlfcn.h>

#include <glib.h>

extern "C" {
// A function of libtsan: the work of a thread before it releases `at` comes before that of another
// thread after it acquires `at`.
void __tsan_acquire(void* at);
void __tsan_release(void* at);
}

namespace {

/// GLib's function of that name.
template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

void g_mutex_lock(GMutex* mutex) {
  static auto* const in_glib = next<decltype(g_mutex_lock)>("g_mutex_lock");
  in_glib(mutex);
  __tsan_acquire(mutex);
}

gboolean g_mutex_trylock(GMutex* mutex) {
  static auto* const in_glib = next<decltype(g_mutex_trylock)>("g_mutex_trylock");
  const gboolean locked = in_glib(mutex);
  if (locked) __tsan_acquire(mutex);
  return locked;
}

void g_mutex_unlock(GMutex* mutex) {
  static auto* const in_glib = next<decltype(g_mutex_unlock)>("g_mutex_unlock");
  __tsan_release(mutex);
  in_glib(mutex);
}

void g_cond_wait(GCond* cond, GMutex* mutex) {
  static auto* const in_glib = next<decltype(g_cond_wait)>("g_cond_wait");
  __tsan_release(mutex);
  in_glib(cond, mutex);
  __tsan_acquire(mutex);
}

gboolean g_cond_wait_until(GCond* cond, GMutex* mutex, gint64 end_time) {
  static auto* const in_glib = next<decltype(g_cond_wait_until)>("g_cond_wait_until");
  __tsan_release(mutex);
  const gboolean signalled = in_glib(cond, mutex, end_time);
  __tsan_acquire(mutex);
  return signalled;
}

// The thread that drops the last reference frees what all others have written.
void(g_object_unref)(gpointer object) {
  static auto* const in_glib = next<void(void*)>("g_object_unref");
  __tsan_release(object);
  __tsan_acquire(object);
  in_glib(object);
}

void gst_mini_object_unref(void* object) {
  static auto* const in_gstreamer = next<void(void*)>("gst_mini_object_unref");
  __tsan_release(object);
  __tsan_acquire(object);
  in_gstreamer(object);
}
}
