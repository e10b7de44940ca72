// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/depth/depth_gate.h"

#include <utility>

namespace spidar {
namespace {

class Lock {
 public:
  explicit Lock(GMutex& mutex) : mutex_(mutex) { g_mutex_lock(&mutex_); }
  ~Lock() { g_mutex_unlock(&mutex_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  GMutex& mutex_;
};

}  // namespace

DepthGate::DepthGate(GstObject* owner) : owner_(owner) {
  g_mutex_init(&mutex_);
  g_cond_init(&changed_);
}

DepthGate::~DepthGate() {
  g_cond_clear(&changed_);
  g_mutex_clear(&mutex_);
}

void DepthGate::open() {
  const Lock lock(mutex_);
  match_.flush();
  closed_ = seeking_ = depth_flushing_ = video_flushing_ = video_ended_ = false;
}

void DepthGate::close() {
  const Lock lock(mutex_);
  closed_ = true;
  match_.flush();
  g_cond_broadcast(&changed_);
}

void DepthGate::set_linked(bool linked) {
  const Lock lock(mutex_);
  linked_ = linked;
  g_cond_broadcast(&changed_);
}

GstFlowReturn DepthGate::add(DepthImage image) {
  const Lock lock(mutex_);
  while (!match_.has_room() && !closed_ && !depth_flushing_ && !video_ended_) {
    g_cond_wait(&changed_, &mutex_);
  }
  if (closed_ || depth_flushing_) return GST_FLOW_FLUSHING;
  if (video_ended_) return GST_FLOW_EOS;
  match_.add(std::move(image));
  g_cond_broadcast(&changed_);
  return GST_FLOW_OK;
}

void DepthGate::reach(gint64 running_ns) {
  const Lock lock(mutex_);
  match_.reach(running_ns);
  g_cond_broadcast(&changed_);
}

void DepthGate::finish_depth() {
  const Lock lock(mutex_);
  match_.finish();
  g_cond_broadcast(&changed_);
}

void DepthGate::begin_depth() {
  const Lock lock(mutex_);
  match_.resume();
}

void DepthGate::flush_depth(bool begin) {
  const Lock lock(mutex_);
  depth_flushing_ = begin;
  match_.flush();
  g_cond_broadcast(&changed_);
}

DepthGate::Found DepthGate::find(const ShownTime& frame, guint64 max_age_ns, GstClock* clock,
                                 GstClockTime deadline_ns) {
  Found found;
  GstClockID timer = nullptr;
  {
    const Lock lock(mutex_);
    const auto waits = [&] {
      return linked_ && !closed_ && !video_flushing_ && (seeking_ || !match_.settled(frame));
    };
    while (waits()) {
      g_cond_broadcast(&changed_);  // an image was consumed, so there is room for another
      if (clock) {
        if (gst_clock_get_time(clock) >= deadline_ns) break;
        if (!timer) {
          timer = gst_clock_new_single_shot_id(clock, deadline_ns);
          auto* const object = static_cast<GstObject*>(gst_object_ref(owner_));
          gst_clock_id_wait_async(timer, wake, new Alarm{this, object}, [](gpointer data) {
            auto* const alarm = static_cast<Alarm*>(data);
            gst_object_unref(alarm->owner);
            delete alarm;
          });
        }
      }
      g_cond_wait(&changed_, &mutex_);
    }
    g_cond_broadcast(&changed_);
    if (closed_ || video_flushing_) {
      found.flow = GST_FLOW_FLUSHING;
    } else if (const DepthImage* image = match_.find(frame, max_age_ns)) {
      found.image.buffer.reset(gst_buffer_ref(image->buffer.get()));
      found.image.caps.reset(gst_caps_ref(image->caps.get()));
      found.image.time = image->time;
    }
  }
  if (timer) {
    gst_clock_id_unschedule(timer);
    gst_clock_id_unref(timer);
  }
  return found;
}

gboolean DepthGate::wake(GstClock*, GstClockTime, GstClockID, gpointer alarm) {
  DepthGate& self = *static_cast<Alarm*>(alarm)->gate;
  const Lock lock(self.mutex_);
  g_cond_broadcast(&self.changed_);
  return TRUE;
}

void DepthGate::finish_video() {
  const Lock lock(mutex_);
  video_ended_ = true;
  g_cond_broadcast(&changed_);
}

void DepthGate::begin_video() {
  const Lock lock(mutex_);
  video_ended_ = false;
}

void DepthGate::flush_video(bool begin) {
  const Lock lock(mutex_);
  video_flushing_ = begin;
  video_ended_ = false;
  g_cond_broadcast(&changed_);
}

void DepthGate::begin_seek() {
  const Lock lock(mutex_);
  seeking_ = true;
}

void DepthGate::end_seek() {
  const Lock lock(mutex_);
  seeking_ = false;
  g_cond_broadcast(&changed_);
}

}  // namespace spidar
