// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/debug_window.h"

#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <chrono>
#include <cmath>
#include <ctime>
#include <imgui.h>
#include <stdexcept>

#include <GLFW/glfw3.h>

#include "plugin/window/program/model/relief_view.h"

namespace spidar {
namespace {

constexpr int kWidth = 1280, kHeight = 800;
/// At a scale of 1: what is smaller cannot be read.
constexpr int kLeastWidth = 640, kLeastHeight = 480;
constexpr double kNote_s = 4;
/// So long after a frame the plots stand still, so that the end of a film stays to be looked at.
constexpr double kIdle_s = 1;
/// Of the small pictures of the last minute: 240 of them take some 20 MB, and while the picture is
/// touched their reliefs 35 MB.
constexpr int kStillWidth_px = 256;

/// Of text, in the coordinates of the window: where a screen has several pixels to one of them, as
/// with Wayland, the frame buffer has them already.
double text_scale(GLFWwindow* window) {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window, &x, &y);
  int width = 0, pixels = 0, ignored = 0;
  glfwGetWindowSize(window, &width, &ignored);
  glfwGetFramebufferSize(window, &pixels, &ignored);
  const double ratio = width > 0 && pixels > 0 ? static_cast<double>(pixels) / width : 1;
  return std::clamp(std::max(x, y) / ratio, 0.5, 8.0);
}

/// CLOCK_MONOTONIC, as the ticks of the haptic loop have it.
double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

DebugWindow::DebugWindow(PlayerLink& link) : link_(link), state_(link.state()) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
  window_ = glfwCreateWindow(kWidth, kHeight, (state_.name + " - what is felt").c_str(), nullptr,
                             nullptr);
  if (!window_) {
    const char* why = nullptr;
    glfwGetError(&why);
    throw std::runtime_error(why ? why : "no window");
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(0);  // the program keeps the pace itself
  ImGui::CreateContext();
  scale_ = text_scale(window_);
  glfwSetWindowSizeLimits(window_, static_cast<int>(kLeastWidth * scale_),
                          static_cast<int>(kLeastHeight * scale_), GLFW_DONT_CARE, GLFW_DONT_CARE);
  ImGui::GetIO().IniFilename = nullptr;
  fonts_ = load_fonts(scale_);
  set_style(scale_);
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  shown_width_ = static_cast<int>(lay_out(width, height, scale_).picture.width);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (action == GLFW_RELEASE || ImGui::GetIO().WantTextInput) return;
    static_cast<DebugWindow*>(glfwGetWindowUserPointer(window))->on_key(key);
  });
  ImGui_ImplGlfw_InitForOpenGL(window_, true);  // calls the one above, too
  ImGui_ImplOpenGL3_Init("#version 330 core");
  texture_.emplace();
  past_texture_.emplace();
  relief_texture_.emplace();
}

DebugWindow::~DebugWindow() {
  end_choices();
  link_.lead_hand(std::nullopt);
  texture_.reset();
  past_texture_.reset();
  relief_texture_.reset();
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
}

bool DebugWindow::is_done() const {
  return glfwWindowShouldClose(window_) != 0;
}

void DebugWindow::say(const std::string& note) {
  note_ = note;
  note_until_s_ = now_s() + kNote_s;
}

void DebugWindow::read() {
  state_ = link_.state();
  const int64_t before_ns = facts_.running_ns;
  const std::string film_before = facts_.film.name();
  // The picture of the moment at which the device is: that on the screen.
  const bool plays = state_.device && state_.device->last.playing;
  std::optional<WindowFrame> frame =
      link_.frames().show(plays ? std::optional(state_.device->last.running_ns) : std::nullopt);
  const int width = std::max(shown_width_, 1);
  if (frame) {
    picture_ = std::move(frame->picture);
    facts_ = std::move(frame->facts);
    frame_s_ = now_s();
  }
  if (picture_.is_there() && (frame || width != loaded_width_)) {
    loaded_width_ = width;
    texture_->load(picture_, width);
  }
  if (frame) {
    sightings_.see(facts_);
    follow_choices(film_before);
    // Another stream, or the same from the beginning: what was learnt is not of it.
    if (facts_.running_ns < before_ns) timeline_.forget();
  }
  record(frame.has_value());
  show_past();
}

void DebugWindow::record(bool is_new) {
  const std::vector<ForceTick> ticks = link_.take_ticks();
  Moment now;
  now.time_s = now_s();
  if (!picture_.is_there() || now.time_s > frame_s_ + kIdle_s) return;
  now.interval_s = is_new ? facts_.interval_s : 0;
  now.speed_px_s = facts_.speed_px_s;
  now.wanted = facts_.scene.wrench;
  if (state_.device) {
    const TickRecord& last = state_.device->last;
    now.felt = last.delivered;
    now.asked = last.wanted;
    now.tension_N = last.tension_N;
    now.pose = last.pose;
    now.contact = last.contact;
    for (const ForceTick& tick : ticks) timeline_.add(tick);
  } else {
    timeline_.add(ForceTick{static_cast<int64_t>(1e9 * now.time_s), now.wanted.force_N});
  }
  timeline_.add(now);
  // The first picture of a scene, too, so that a pause does not show the scene before.
  const bool begins_scene = facts_.interval_s == 0;
  if (is_new && (begins_scene || timeline_.wants_still(now.time_s))) keep_still(now.time_s);
}

void DebugWindow::keep_still(double time_s) {
  auto still = std::make_shared<Still>();
  if (!texture_->copy_to(*still, kStillWidth_px)) return;
  still->time_s = time_s;
  still->facts = facts_;
  timeline_.add_still(std::move(still));
}

/// In a pause the window shows the grip and the picture of the moment that is looked at.
void DebugWindow::show_past() {
  const Timeline::Part moments = timeline_.plotted();
  if (!timeline_.is_paused() || moments.empty()) {
    past_.reset();
    return;
  }
  if (state_.device) {
    TickRecord& last = state_.device->last;
    last.delivered = moments.back().felt;
    last.wanted = moments.back().asked;
    last.tension_N = moments.back().tension_N;
    last.pose = moments.back().pose;
    last.contact = moments.back().contact;
  }
  std::shared_ptr<const Still> still = timeline_.still();
  if (still && still != past_) past_texture_->load(*still);
  past_ = std::move(still);
}

void DebugWindow::show_relief(const TouchScene& touch) {
  if (touch.relief == relief_) return;
  relief_ = touch.relief;
  if (!relief_) return;
  Still shaded;
  shade_relief(*relief_, shaded);
  relief_texture_->load(shaded);
}

ShownPicture DebugWindow::shown_picture(const FrameFacts& facts) const {
  ShownPicture picture;
  picture.arrow_scale = state_.value("arrow-scale", 1);
  picture.max_force_N = facts_.controller.max_force_N;
  picture.detail = detail_;
  if (show_relief_ && relief_) picture.relief = (ImTextureID)uintptr_t{relief_texture_->id()};
  if (state_.device) picture.touch = touch_mark(facts.touch, state_.device->last);
  const PictureTexture& texture = past_ ? *past_texture_ : *texture_;
  if (texture.empty()) return picture;
  // Dear ImGui's backend for OpenGL takes the name of a texture for its identifier, which is a
  // pointer or, since 1.91.4, a number: a cast as in C makes either.
  picture.texture = (ImTextureID)uintptr_t{texture.id()};
  picture.frame_width = texture.frame_width();
  picture.frame_height = texture.frame_height();
  picture.pixel_aspect = texture.pixel_aspect();
  return picture;
}

void DebugWindow::draw_panels(int width, int height) {
  const WindowLayout layout = lay_out(width, height, scale_);
  const Brush brush{*ImGui::GetBackgroundDrawList(), scale_, fonts_};
  const FrameFacts& facts = past_ ? past_->facts : facts_;
  const ControllerSettings& controller = facts.controller;
  shown_width_ = static_cast<int>(layout.picture.width);
  show_relief(facts.touch);
  const ShownPicture picture = shown_picture(facts);
  const Rect shown = shown_rect(layout.picture, picture, facts);
  draw_picture(brush, layout.picture, picture, facts);
  const Mouse mouse = given_mouse_ ? *given_mouse_ : read_mouse();
  use_mouse(mouse, shown, facts);
  use_plots(mouse, layout);
  if (const std::string line = hint(facts); !line.empty()) draw_hint(brush, shown, line);
  draw_grip(brush, layout.grip, state_);
  draw_tensions(brush, layout.tensions, state_);
  draw_choices(brush, layout.timeline);
  draw_force(brush, layout.force, timeline_, controller.max_force_N);
  draw_speed(brush, layout.speed, timeline_);
  if (facts.touch.on && state_.device) {
    draw_section(brush, layout.gain, facts.touch, state_.device->last);
  } else {
    draw_gain(brush, layout.gain, timeline_, controller);
  }
  if (now_s() > note_until_s_) note_.clear();
  draw_status(brush, layout.status, state_, facts, note_);
  draw_controls(brush, layout.controls, state_,
                [this](const std::string& setting, double value) { change(setting, value); });
  draw_switches(brush, layout.picture, detail_, relief_ ? &show_relief_ : nullptr);
  if (help_) draw_help(scale_);
}

void DebugWindow::draw() {
  glfwGetFramebufferSize(window_, &width_, &height_);
  read();
  if (width_ <= 0 || height_ <= 0) return;  // minimised
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  int window_width = 0, window_height = 0;
  glfwGetWindowSize(window_, &window_width, &window_height);
  draw_panels(window_width, window_height);
  ImGui::Render();
  glViewport(0, 0, width_, height_);
  const ImVec4 back = ImGui::ColorConvertU32ToFloat4(kBackColor);
  glClearColor(back.x, back.y, back.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (save_wanted_) save_here();
}

void DebugWindow::present() {
  glfwSwapBuffers(window_);
}

std::string DebugWindow::save(const std::string& path) const {
  if (width_ <= 0 || height_ <= 0) return "the window is minimised";
  std::vector<uint8_t> rgb(3 * static_cast<size_t>(width_) * static_cast<size_t>(height_));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
  return write_png(rgb, width_, height_, path);
}

void DebugWindow::save_here() {
  save_wanted_ = false;
  char path[64];
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::strftime(path, sizeof path, "spidar-window-%Y%m%d-%H%M%S.png", &local);
  const std::string problem = save(path);
  say(problem.empty() ? std::string("saved ") + path : std::string(path) + ": " + problem);
}

}  // namespace spidar
