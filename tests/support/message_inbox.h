// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>

#include <gst/gst.h>

namespace spidar::test {

/// All messages of a pipeline in their order, taken from a bus in the threads that post them. The
/// bus itself may lose a message: its queue (GstAtomicQueue of GStreamer 1.22) begins with 32
/// positions, and when two threads post while it grows and a third one reads, a reader may leave
/// the old positions for the new ones before an interrupted thread has written its message to the
/// old ones. A message is here before the bus emits its "sync-message" signal.
class MessageInbox {
 public:
  explicit MessageInbox(GstElement* pipeline) : bus_(gst_element_get_bus(pipeline)) {
    gst_bus_set_sync_handler(bus_, keep, this, nullptr);
  }
  /// The pipeline must be in NULL.
  ~MessageInbox() {
    gst_bus_set_sync_handler(bus_, nullptr, nullptr, nullptr);
    gst_object_unref(bus_);
    for (GstMessage* message : messages_) gst_message_unref(message);
  }
  MessageInbox(const MessageInbox&) = delete;
  MessageInbox& operator=(const MessageInbox&) = delete;

  /// Returns the next message, which belongs to the caller; null when there is none.
  GstMessage* pop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return take_first();
  }
  GstMessage* await() {
    std::unique_lock<std::mutex> lock(mutex_);
    posted_.wait(lock, [this] { return !messages_.empty(); });
    return take_first();
  }

 private:
  static GstBusSyncReply keep(GstBus*, GstMessage* message, gpointer self) {
    auto* inbox = static_cast<MessageInbox*>(self);
    const std::lock_guard<std::mutex> lock(inbox->mutex_);
    inbox->messages_.push_back(gst_message_ref(message));
    inbox->posted_.notify_all();
    return GST_BUS_PASS;  // the bus does not signal dropped messages to the elements that need them
  }

  GstMessage* take_first() {
    while (GstMessage* copy = gst_bus_pop(bus_)) gst_message_unref(copy);
    if (messages_.empty()) return nullptr;
    GstMessage* message = messages_.front();
    messages_.pop_front();
    return message;
  }

  GstBus* bus_;
  std::mutex mutex_;
  std::condition_variable posted_;
  std::deque<GstMessage*> messages_;
};

}  // namespace spidar::test
