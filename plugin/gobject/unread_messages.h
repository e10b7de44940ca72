// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>

#include <gst/gst.h>

namespace spidar {

/// Limits the messages of an element that wait on its bus, because perhaps nobody reads them. Lives
/// as long as the element. Any thread.
class UnreadMessages {
 public:
  /// The most waiting messages: unread ones would fill the memory by hundreds of megabytes an hour.
  /// At 25 frames/s, an application has 40 s to read its bus.
  static constexpr int kMax = 1000;

  /// Posts the message that `make()` returns, or nothing while kMax messages wait.
  template <typename Make>
  void post(GstElement* element, Make&& make) {
    if (count_ >= kMax) return;
    GstMessage* const message = make();
    ++count_;
    // The message holds the element until it is freed, which calls this.
    const auto count_down = [](gpointer count, GstMiniObject*) {
      --*static_cast<std::atomic<int>*>(count);
    };
    gst_mini_object_weak_ref(GST_MINI_OBJECT_CAST(message), count_down, &count_);
    gst_element_post_message(element, message);
  }

 private:
  std::atomic<int> count_{0};
};

}  // namespace spidar
