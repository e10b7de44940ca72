// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/model/frame_queue.h"

#include <utility>

namespace spidar {

void FrameQueue::drop_oldest() {
  spare_ = std::move(waiting_.front());
  waiting_.pop_front();
}

void FrameQueue::fill(FrameFeed& feed) {
  for (;;) {
    if (!spare_) spare_ = std::make_unique<Frame>();
    if (!feed.take(spare_->picture, spare_->facts)) return;
    const int64_t running_ns = spare_->facts.running_ns;
    if (!waiting_.empty() && running_ns < waiting_.back()->facts.running_ns) waiting_.clear();
    waiting_.push_back(std::move(spare_));
  }
}

bool FrameQueue::show(std::optional<int64_t> running_ns, PictureCopy& picture, FrameFacts& facts) {
  const auto is_due = [&](const Frame& frame) {
    return !running_ns || frame.facts.running_ns <= *running_ns || waiting_.size() > kMost;
  };
  bool is_new = false;
  while (!waiting_.empty() && is_due(*waiting_.front())) {
    swap(picture, waiting_.front()->picture);
    facts = waiting_.front()->facts;
    drop_oldest();
    is_new = true;
  }
  return is_new;
}

}  // namespace spidar
