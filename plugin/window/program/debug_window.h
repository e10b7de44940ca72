// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/window/program/model/object_click.h"
#include "plugin/window/program/model/scene_choices.h"
#include "plugin/window/program/panels.h"
#include "plugin/window/program/picture_texture.h"
#include "plugin/window/program/player_link.h"

struct GLFWwindow;

namespace spidar::window {

class DebugWindow {
 public:
  /// `link` must have answered once. Throws std::runtime_error without OpenGL 3.3 or a window.
  explicit DebugWindow(PlayerLink& link);
  ~DebugWindow();
  DebugWindow(const DebugWindow&) = delete;
  DebugWindow& operator=(const DebugWindow&) = delete;

  /// Draws one frame of the window, which present() brings to the screen.
  void draw();
  void present();
  /// Whether the user has closed the window.
  bool is_done() const;
  /// Writes what was drawn but not yet presented to a PNG file. Returns an empty string, or why the
  /// file cannot be written.
  std::string save(const std::string& path) const;

  void on_key(int key);
  /// Processes input in place of the user's.
  void process(const UserInput& input);

 private:
  void read();
  void record(bool is_new);
  ShownPicture shown_picture() const;
  bool offers_hand() const;
  std::string hint() const;
  void use_mouse(const Mouse& mouse, const Rect& picture);
  void use_plots(const Mouse& mouse, const Layout& layout);
  SceneChoices& choices();
  void follow_choices(const std::string& film_before);
  void choose(const ChoiceRequest& request);
  bool has_unsaved_choices() const;
  void save_choices(bool (SceneChoices::*is_due)() const);
  void remove_choice(const FeelRule& rule);
  void end_choices();
  void draw_choices(const Brush& brush, const Rect& panel);
  void set_scale(double scale);
  void draw_panels(int width, int height);
  void save_here();
  void draw_controls_and_use(const Brush& brush, const Rect& panel);
  void change(const std::string& setting, double value) { link_.change(setting, value); }
  void use_settings(size_t which);
  void toggle_play();
  void follow_title();
  void show_note(const std::string& note);

  PlayerLink& link_;
  GLFWwindow* window_ = nullptr;
  double screen_scale_ = 1, scale_ = 1;  ///< of text: that of the screen, and in this window
  Fonts fonts_;
  std::optional<PictureTexture> texture_, relief_;
  int width_ = 0, height_ = 0;  ///< of the last frame buffer

  ElementState state_;
  SharedPicture picture_;
  DrawnFrame report_;
  double frame_s_ = 0;  ///< when the last frame came
  Timeline timeline_;
  int shown_width_ = 0, loaded_width_ = 0;  ///< of the picture in the window, and its texture
  MouseHand hand_;
  ObjectClick click_;
  /// The object of a click that no frame contains yet, see ShownPicture; and the click before it.
  std::optional<uint32_t> requested_;
  uint32_t click_before_ = 0;
  SettingsComparison settings_;
  std::string title_;
  SeenObjects seen_objects_;
  std::map<std::string, SceneChoices> choices_;  ///< of each film by its path
  bool has_clicked_ = false;                     ///< the user knows what a click does
  std::optional<Mouse> given_mouse_;
  bool detail_ = false, keys_ = false;
  bool save_wanted_ = false;
  std::string note_;
  double note_until_s_ = 0;
};

}  // namespace spidar::window
