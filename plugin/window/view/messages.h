// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The messages between a player and its window.
///
/// The window requests what it draws next (RequestFrames). The player answers with the frames that
/// have passed since, and then with the state of the element (ElementState). A slow window
/// therefore gets less, and nothing waits for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "core/choice/feel_rules.h"
#include "plugin/window/view/mouse_hand.h"
#include "plugin/window/view/window_view.h"

namespace spidar::window {

/// Raise this when a message changes: a player and a window of different versions then report that
/// instead of misunderstanding each other.
constexpr uint16_t kProtocol = 5;

// --- to the window

/// Memory for pictures, which replaces any before. Its file comes with the message.
struct PictureMemory {
  static constexpr uint32_t kMaxSlots = 64;

  uint32_t id = 0;
  std::string caps;  ///< format and size of each picture, as GStreamer writes them
  uint32_t slots = 0;
  uint64_t slot_bytes = 0;
};
/// A frame whose picture is in a slot, which belongs to the window until it sends SlotFree.
struct FrameShown {
  uint32_t memory = 0, slot = 0;
  DrawnFrame report;
};
/// Answers SaveChoices.
struct ChoicesSaved {
  bool is_done = false;
  std::string what;  ///< what was done, or why not, as a sentence
};
/// Requests a picture of the window in a PNG file. PictureTaken answers.
struct TakePicture {
  std::string path;
};
/// Input in place of a person's, for tests: a key of GLFW, the mouse from now on, another size.
struct UserInput {
  std::optional<int32_t> key;
  std::optional<Mouse> mouse;
  std::optional<Eigen::Vector2d> size_px;
};
/// The window must close, and has Window::kCloseTimeout for that.
struct Close {};

using ToWindow = std::variant<PictureMemory, FrameShown, ElementState, ChoicesSaved, TakePicture,
                              UserInput, Close>;

// --- from the window

struct RequestFrames {};
struct SlotFree {
  uint32_t memory = 0, slot = 0;
};
/// Sets a property; a value out of range is clamped.
struct ChangeSetting {
  std::string name;
  double value = 0;
};
struct LoadPreset {
  std::string name;
};
/// The target of the simulated device's hand, in the device frame; nothing: the hand is released.
struct LeadHand {
  std::optional<Eigen::Vector3d> to_m;
};
/// Only the object at this position of the frame is felt, a fraction of its visible part; nothing:
/// what the properties choose is felt.
struct ChooseObject {
  std::optional<Eigen::Vector2d> position;
};
/// Changes the rules in the file of `feel`, or else in the one beside the file `film`.
struct SaveChoices {
  std::string film;
  std::vector<FeelEdit> edits;
};
struct PlayFilm {
  bool plays = false;
};
struct SeekFilm {
  int64_t to_ns = 0;
};
struct PictureTaken {
  std::string error;  ///< empty when the picture was written
};
/// The window cannot be opened: `what` says what happened, `advice` what to do.
struct CannotOpen {
  std::string what, advice;
};

using FromWindow =
    std::variant<RequestFrames, SlotFree, ChangeSetting, LeadHand, ChooseObject, SaveChoices,
                 PlayFilm, SeekFilm, PictureTaken, CannotOpen, LoadPreset>;

/// The bytes of a message, which begin with its kind.
std::vector<uint8_t> to_bytes(const ToWindow& message);
std::vector<uint8_t> to_bytes(const FromWindow& message);
/// Returns nothing unless the bytes are exactly one message, with enumerations and sizes in their
/// range. For other values, see is_possible().
std::optional<ToWindow> to_window(const std::vector<uint8_t>& bytes);
std::optional<FromWindow> from_window(const std::vector<uint8_t>& bytes);
/// Whether the numbers of a request are finite, its positions in the picture and its times in a
/// film. Only the element knows the range of a setting and of the hand.
bool is_possible(const FromWindow& request);

}  // namespace spidar::window
