// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/player_link.h"

#include <algorithm>
#include <cerrno>
#include <poll.h>
#include <utility>

namespace spidar::window {
namespace {

/// A file of rules is short, but the disk may be asleep.
constexpr std::chrono::seconds kSaveTimeout{2};

}  // namespace

void FrameQueue::add(QueuedFrame frame) {
  // Without a flush, the frames of the previous run are still shown first.
  if (!waiting_.empty()) {
    const FrameStamp &now = frame.report.stamp, &before = waiting_.back().report.stamp;
    if (now.epoch != before.epoch && now.running_ns <= before.running_ns) waiting_.clear();
  }
  waiting_.push_back(std::move(frame));
}

std::optional<QueuedFrame> FrameQueue::show(std::optional<int64_t> running_ns) {
  const auto is_due = [&](const QueuedFrame& frame) {
    return !running_ns || frame.report.stamp.running_ns <= *running_ns || waiting_.size() > kMax;
  };
  std::optional<QueuedFrame> shown;
  while (!waiting_.empty() && is_due(waiting_.front())) {
    shown = std::move(waiting_.front());
    waiting_.pop_front();
  }
  return shown;
}

/// Waits for a message. Returns false when the time is over, or the player is gone.
bool PlayerLink::wait(std::chrono::steady_clock::time_point until) {
  while (!channel_->is_gone()) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                          until - std::chrono::steady_clock::now())
                          .count();
    const auto events = static_cast<short>(POLLIN | (channel_->has_unsent() ? POLLOUT : 0));
    pollfd file{channel_->socket(), events, 0};
    const int found = poll(&file, 1, static_cast<int>(std::max<int64_t>(left, 0)));
    if (found < 0 && errno != EINTR) return false;
    if (found > 0 && (file.revents & POLLOUT)) channel_->flush();
    if (found > 0 && (file.revents & ~POLLOUT)) return true;
    if (found == 0 && left <= 0) return false;
  }
  return false;
}

void PlayerLink::receive() {
  channel_->fill();
  while (const std::optional<std::vector<uint8_t>> packet = channel_->next()) {
    std::optional<ToWindow> message = to_window(*packet);
    if (!message) {
      is_incompatible_ = true;
      return;
    }
    process(std::move(*message));
  }
}

void PlayerLink::request_frame(std::chrono::milliseconds patience) {
  if (is_over()) return;
  // One request at a time: the answer to an earlier one is as good.
  if (is_answered_ || state_.name.empty()) send(RequestFrames());
  is_answered_ = false;
  const std::chrono::steady_clock::time_point until = std::chrono::steady_clock::now() + patience;
  while (!is_answered_ && !is_over() && wait(until)) receive();
}

void PlayerLink::pause(std::chrono::milliseconds duration) {
  const std::chrono::steady_clock::time_point until = std::chrono::steady_clock::now() + duration;
  while (!is_over() && !wanted_picture_ && wait(until)) receive();
}

void PlayerLink::process(ToWindow&& message) {
  if (const auto* memory = std::get_if<PictureMemory>(&message)) {
    take_memory(*memory);
  } else if (auto* frame = std::get_if<FrameShown>(&message)) {
    take_frame(std::move(*frame));
  } else if (auto* state = std::get_if<ElementState>(&message)) {
    state_ = std::move(*state);
    is_answered_ = true;
    if (state_.device) {
      std::vector<ForceTick>& ticks = state_.device->ticks;
      ticks_.insert(ticks_.end(), ticks.begin(), ticks.end());
      ticks.clear();
    }
  } else if (auto* saved = std::get_if<ChoicesSaved>(&message)) {
    saved_ = std::move(*saved);
  } else if (auto* picture = std::get_if<TakePicture>(&message)) {
    wanted_picture_ = std::move(picture->path);
  } else if (const auto* input = std::get_if<UserInput>(&message)) {
    inputs_.push_back(*input);
  } else {
    is_closed_ = true;
  }
}

void PlayerLink::take_memory(const PictureMemory& memory) {
  memory_ = std::make_shared<const MappedPictures>(memory, channel_->take_file());
  if (!memory_->is_there()) memory_.reset();
}

void PlayerLink::take_frame(FrameShown&& frame) {
  if (!memory_ || memory_->description().id != frame.memory ||
      frame.slot >= memory_->description().slots) {
    send(SlotFree{frame.memory, frame.slot});
    return;
  }
  const SlotFree free{frame.memory, frame.slot};
  frames_.add(
      {SharedPicture(memory_, frame.slot,
                     [channel = channel_, free] { channel->send(to_bytes(FromWindow(free))); }),
       std::move(frame.report)});
}

void PlayerLink::picture_taken(const std::string& error) {
  wanted_picture_.reset();
  send(PictureTaken{error});
}

void PlayerLink::lead_hand(const std::optional<Eigen::Vector3d>& to_m) {
  if (to_m == led_to_m_) return;
  led_to_m_ = to_m;
  send(LeadHand{to_m});
}

ChoicesSaved PlayerLink::save(const std::string& film, const std::vector<FeelEdit>& edits) {
  saved_.reset();
  const std::vector<uint8_t> request = to_bytes(FromWindow(SaveChoices{film, edits}));
  if (request.size() > Channel::kFromWindow.bytes) return {false, "Not saved: too many choices."};
  channel_->send(request);
  const std::chrono::steady_clock::time_point until =
      std::chrono::steady_clock::now() + kSaveTimeout;
  while (!saved_ && wait(until)) receive();
  return saved_.value_or(ChoicesSaved{false, "Not saved: the player does not answer."});
}

void PlayerLink::cannot_open(const std::string& what, const std::string& advice) {
  send(CannotOpen{what, advice});
}

}  // namespace spidar::window
