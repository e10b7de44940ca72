// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/window/view/channel.h"
#include "plugin/window/view/messages.h"
#include "plugin/window/view/shared_pictures.h"
#include "plugin/window/view/window_view.h"

namespace spidar::window {

struct QueuedFrame {
  SharedPicture picture;
  DrawnFrame report;
};

/// The element sees a frame before the sink shows it, and the grip feels it when the sink shows it:
/// frames wait here until then to be drawn beside the grip.
class FrameQueue {
 public:
  /// With more frames, as between the element and a sink with a long queue, the oldest is shown
  /// although it is not on the screen yet.
  static constexpr size_t kMax = 8;

  /// An earlier running time than before, of another stream or a seek, drops all waiting frames.
  void add(QueuedFrame frame);
  /// Returns the newest frame on the screen at this running time; without a running time, while
  /// nothing is felt, the newest of all. Nothing when there is no other frame than before.
  std::optional<QueuedFrame> show(std::optional<int64_t> running_ns);

 private:
  std::deque<QueuedFrame> waiting_;
};

/// The player as its window sees it, through the socket between them. One thread.
class PlayerLink {
 public:
  explicit PlayerLink(int socket)
      : channel_(std::make_shared<Channel>(socket, Channel::kFromPlayer)) {}

  /// Requests what to draw next, and waits for the answer, no longer than `patience`.
  void request_frame(std::chrono::milliseconds patience);
  /// Waits for `duration`, but not when the window must close or write its picture.
  void pause(std::chrono::milliseconds duration);

  /// Whether the player has closed the window, or is gone.
  bool is_over() const { return is_closed_ || is_incompatible_ || channel_->is_gone(); }
  /// Whether the player sends something other than messages, as one of another version does.
  bool is_incompatible() const { return is_incompatible_ || channel_->is_incompatible(); }

  const ElementState& state() const { return state_; }
  std::vector<ForceTick> take_ticks() { return std::exchange(ticks_, {}); }
  FrameQueue& frames() { return frames_; }
  std::vector<UserInput> take_inputs() { return std::exchange(inputs_, {}); }
  /// The file into which the next drawing must be saved, if any.
  std::optional<std::string> wanted_picture() const { return wanted_picture_; }
  /// Tells the element whether the picture was written, see PictureTaken.
  void picture_taken(const std::string& error);

  void change(const std::string& setting, double value) { send(ChangeSetting{setting, value}); }
  void load_preset(const std::string& name) { send(LoadPreset{name}); }
  void lead_hand(const std::optional<Eigen::Vector3d>& to_m);
  void choose(const std::optional<Eigen::Vector2d>& position) { send(ChooseObject{position}); }
  void play(bool plays) { send(PlayFilm{plays}); }
  void seek(int64_t to_ns) { send(SeekFilm{to_ns}); }
  /// Waits briefly for the answer.
  ChoicesSaved save(const std::string& film, const std::vector<FeelEdit>& edits);
  void cannot_open(const std::string& what, const std::string& advice);

 private:
  void send(const FromWindow& message) { channel_->send(to_bytes(message)); }
  bool wait(std::chrono::steady_clock::time_point until);
  void receive();
  void process(ToWindow&& message);
  void take_memory(const PictureMemory& memory);
  void take_frame(FrameShown&& frame);

  std::shared_ptr<Channel> channel_;  ///< shared with the pictures, which free their slots
  std::shared_ptr<const MappedPictures> memory_;
  FrameQueue frames_;
  ElementState state_;
  std::vector<ForceTick> ticks_;
  std::vector<UserInput> inputs_;
  std::optional<std::string> wanted_picture_;
  std::optional<ChoicesSaved> saved_;
  std::optional<Eigen::Vector3d> led_to_m_;
  bool is_answered_ = false;
  bool is_closed_ = false;
  bool is_incompatible_ = false;
};

}  // namespace spidar::window
