// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a player and its window send to each other.
///
/// The window asks for what it draws next (Ask). The player answers with the frames that have
/// passed since, and then with the state of the element (ElementState). A window that is slow
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

/// To be raised when a message changes: a player and a window of different versions report it
/// instead of misunderstanding each other.
constexpr uint16_t kProtocol = 5;

// --- to the window

/// Memory for pictures, which replaces any before it. Its file comes with the message.
struct PictureMemory {
  static constexpr uint32_t kMaxSlots = 64;

  uint32_t id = 0;
  std::string caps;  ///< format and size of each picture, as GStreamer writes it
  uint32_t slots = 0;
  uint64_t slot_bytes = 0;
};
/// A frame whose picture is in a slot, which is the window's until it sends SlotFree.
struct FrameShown {
  uint32_t memory = 0, slot = 0;
  DrawnFrame report;
};
/// Answers SaveChoices.
struct ChoicesSaved {
  bool is_done = false;
  std::string what;  ///< was done, or why not, as a sentence
};
/// Asks for a drawing, written to a PNG file. PictureTaken answers.
struct TakePicture {
  std::string path;
};
/// Input in place of a person's, for tests: a key of GLFW, the mouse from now on, another size.
struct UserInput {
  std::optional<int32_t> key;
  std::optional<Mouse> mouse;
  std::optional<Eigen::Vector2d> size_px;
};
/// The window is to close, and has Window::kPatience for it.
struct Close {};

using ToWindow = std::variant<PictureMemory, FrameShown, ElementState, ChoicesSaved, TakePicture,
                              UserInput, Close>;

// --- from the window

struct Ask {};
struct SlotFree {
  uint32_t memory = 0, slot = 0;
};
/// Sets a property; a value that is out of range is brought into it.
struct ChangeSetting {
  std::string name;
  double value = 0;
};
struct LoadPreset {
  std::string name;
};
/// Where the hand of the simulated device moves to, in the device frame; nothing: it lets go.
struct LeadHand {
  std::optional<Eigen::Vector3d> to_m;
};
/// The object at this position of the frame, a fraction of its visible part, is felt alone;
/// nothing: what the properties choose is felt.
struct ChooseObject {
  std::optional<Eigen::Vector2d> position;
};
/// Changes the rules in the file of `feel`, or else in the one beside the file `film`.
struct SaveChoices {
  std::string film;
  std::vector<FeelEdit> edits;
};
/// The film is to play or to pause.
struct PlayFilm {
  bool plays = false;
};
/// The film is to continue from this time.
struct SeekFilm {
  int64_t to_ns = 0;
};
struct PictureTaken {
  std::string error;  ///< empty when it was written
};
/// The window cannot be opened: `what` says what happened, `advice` what to do.
struct CannotOpen {
  std::string what, advice;
};

using FromWindow = std::variant<Ask, SlotFree, ChangeSetting, LeadHand, ChooseObject, SaveChoices,
                                PlayFilm, SeekFilm, PictureTaken, CannotOpen, LoadPreset>;

/// The bytes of a message, which begin with its kind.
std::vector<uint8_t> to_bytes(const ToWindow& message);
std::vector<uint8_t> to_bytes(const FromWindow& message);
/// Nothing when the bytes are not those of exactly one message, with enumerations and sizes in
/// their range. Of other values, see is_possible().
std::optional<ToWindow> to_window(const std::vector<uint8_t>& bytes);
std::optional<FromWindow> from_window(const std::vector<uint8_t>& bytes);
/// Whether the numbers of a request are finite, its positions in the picture and its times in a
/// film. Whether a setting has such a value, and the hand reaches so far, the element knows.
bool is_possible(const FromWindow& request);

}  // namespace spidar::window
