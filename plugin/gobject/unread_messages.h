// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Messages that an element posts without end, as long as somebody reads them.
#pragma once

#include <atomic>

#include <gst/gst.h>

namespace spidar {

/// Counts the messages of an element that wait on its bus, and lives as long as the element. Any
/// thread.
class UnreadMessages {
 public:
  /// No more wait: unread, they would fill the memory by hundreds of megabytes an hour. At
  /// 25 frames/s an application that reads its bus has 40 s for it.
  static constexpr int kMax = 1000;

  /// Posts the message that `make()` returns, or nothing while kMax wait.
  template <typename Make>
  void post(GstElement* element, Make&& make) {
    if (count_ >= kMax) return;
    GstMessage* const message = make();
    ++count_;
    // When the message is freed. It holds the element until then.
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
