// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/frame_queue.h"

#include <utility>

namespace spidar {

void FrameQueue::add(WindowFrame frame) {
  if (!waiting_.empty() && frame.facts.running_ns < waiting_.back().facts.running_ns) {
    waiting_.clear();
  }
  waiting_.push_back(std::move(frame));
}

std::optional<WindowFrame> FrameQueue::show(std::optional<int64_t> running_ns) {
  const auto is_due = [&](const WindowFrame& frame) {
    return !running_ns || frame.facts.running_ns <= *running_ns || waiting_.size() > kMost;
  };
  std::optional<WindowFrame> shown;
  while (!waiting_.empty() && is_due(waiting_.front())) {
    shown = std::move(waiting_.front());
    waiting_.pop_front();
  }
  return shown;
}

}  // namespace spidar
