// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// One window of GLFW and what is drawn in it.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/window/hand_control.h"
#include "plugin/window/model/frame_feed.h"
#include "plugin/window/model/frame_queue.h"
#include "plugin/window/model/object_click.h"
#include "plugin/window/model/object_list.h"
#include "plugin/window/model/scene_choices.h"
#include "plugin/window/model/window_source.h"
#include "plugin/window/panels.h"
#include "plugin/window/picture_texture.h"
#include "plugin/window/window.h"

struct GLFWwindow;
struct ImGuiContext;

namespace spidar {

/// Everything on the thread that called glfwInit().
class DebugWindow {
 public:
  /// Throws std::runtime_error when there is no OpenGL 3.3 or no window to be had.
  DebugWindow(std::shared_ptr<WindowSource> source, std::shared_ptr<FrameFeed> feed);
  ~DebugWindow();
  DebugWindow(const DebugWindow&) = delete;
  DebugWindow& operator=(const DebugWindow&) = delete;

  /// One frame of the window, which present() brings to the screen.
  void draw();
  void present();
  /// By the user, or because there is nothing to look at any more.
  bool is_done() const;
  /// Of what was drawn and not yet presented.
  Screenshot screenshot() const;

  void resize(int width, int height);
  void on_key(int key);
  /// From the next frame on in place of the mouse; for tests.
  void set_mouse(const Mouse& mouse) { given_mouse_ = mouse; }

 private:
  void read();
  void record(bool is_new);
  void keep_still(double time_s);
  void show_past();
  ShownPicture shown_picture(const FrameFacts& facts) const;
  void show_relief(const TouchScene& touch);
  bool offers_hand() const;
  bool explains_hand(const FrameFacts& facts) const;
  void use_mouse(const Mouse& mouse, const Rect& picture, const FrameFacts& facts);
  void use_plots(const Mouse& mouse, const WindowLayout& layout);
  void list_objects();
  SceneChoices& choices();
  void follow_choices(const std::string& film_before);
  bool is_chosen(const ListedObject& object) const;
  std::vector<ObjectRow> object_list() const;
  void use_objects(const Mouse& mouse, const Rect& panel);
  void choose(const ObjectWish& wish);
  bool has_unsaved_choices() const;
  void save_choices();
  void save_late_ends();
  void save_choices(const std::string& film, SceneChoices& choices);
  void remove_choice(const FeelRule& rule);
  void end_choices();
  void draw_choices(const Brush& brush, const WindowLayout& layout, const Mouse& mouse);
  void draw_panels(int width, int height);
  void save();
  void change(const std::string& setting, double value) { source_->set(setting, value); }
  void say(const std::string& note);
  void make_current() const;
  void install_callbacks();

  std::shared_ptr<WindowSource> source_;
  std::shared_ptr<FrameFeed> feed_;
  GLFWwindow* window_ = nullptr;
  ImGuiContext* context_ = nullptr;
  double scale_ = 1;
  Fonts fonts_;
  std::optional<PictureTexture> texture_, past_texture_, relief_texture_;
  int width_ = 0, height_ = 0;  // of the frame buffer drawn last

  ElementState state_;
  FrameQueue waiting_;
  PictureCopy picture_;
  FrameFacts facts_;
  Timeline timeline_;
  std::shared_ptr<const Still> past_;          // what past_texture_ shows
  int shown_width_ = 0;                        // of the picture in the window
  std::shared_ptr<const HeightField> relief_;  // what relief_texture_ shows
  HandControl hand_;
  ObjectClick click_;
  ObjectList objects_;
  std::optional<std::array<PictureTexture, ObjectList::kMost>> object_textures_;
  std::map<std::string, SceneChoices> choices_;  ///< of each film by its path
  bool objects_down_ = false;
  bool plots_down_ = false;
  std::optional<double> drag_px_;  ///< where a plot was dragged to
  std::optional<Mouse> given_mouse_;
  bool source_gone_ = false;
  bool help_ = false;
  bool detail_ = false;
  bool show_relief_ = true;
  bool save_wanted_ = false;
  std::string note_;
  double note_until_s_ = 0;
};

}  // namespace spidar
