// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/debug_window.h"

#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <cmath>
#include <ctime>
#include <imgui.h>
#include <stdexcept>

#include <GLFW/glfw3.h>

#include "plugin/window/model/relief_view.h"

namespace spidar {
namespace {

constexpr int kWidth = 1280, kHeight = 800;
/// At a scale of 1: what is smaller cannot be read.
constexpr int kLeastWidth = 640, kLeastHeight = 480;
constexpr double kNote_s = 4;
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

}  // namespace

DebugWindow::DebugWindow(std::shared_ptr<WindowSource> source, std::shared_ptr<FrameFeed> feed)
    : source_(std::move(source)), feed_(std::move(feed)), hand_(source_) {
  source_->read(state_);
  glfwDefaultWindowHints();
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
  glfwSwapInterval(0);  // one thread draws all windows and keeps the pace
  context_ = ImGui::CreateContext();
  make_current();
  scale_ = text_scale(window_);
  glfwSetWindowSizeLimits(window_, static_cast<int>(kLeastWidth * scale_),
                          static_cast<int>(kLeastHeight * scale_), GLFW_DONT_CARE, GLFW_DONT_CARE);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  fonts_ = load_fonts(scale_);
  set_style(scale_);
  ImGui_ImplGlfw_InitForOpenGL(window_, false);
  ImGui_ImplOpenGL3_Init("#version 330 core");
  texture_.emplace();
  past_texture_.emplace();
  relief_texture_.emplace();
  object_textures_.emplace();
  install_callbacks();
  feed_->want();
}

DebugWindow::~DebugWindow() {
  end_choices();
  make_current();
  texture_.reset();
  past_texture_.reset();
  relief_texture_.reset();
  object_textures_.reset();
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext(context_);
  glfwMakeContextCurrent(nullptr);
  glfwDestroyWindow(window_);
}

void DebugWindow::make_current() const {
  glfwMakeContextCurrent(window_);
  ImGui::SetCurrentContext(context_);
}

bool DebugWindow::is_done() const {
  return source_gone_ || glfwWindowShouldClose(window_) != 0;
}

void DebugWindow::resize(int width, int height) {
  glfwSetWindowSize(window_, width, height);
}

void DebugWindow::say(const std::string& note) {
  note_ = note;
  note_until_s_ = glfwGetTime() + kNote_s;
}

void DebugWindow::read() {
  source_gone_ = !source_->read(state_);
  const int64_t before_ns = facts_.running_ns;
  const std::string film_before = facts_.film.name();
  waiting_.fill(*feed_);
  // The picture of the moment at which the device is: that on the screen.
  const bool plays = state_.device && state_.device->loop.last.playing;
  const bool is_new = waiting_.show(
      plays ? std::optional(state_.device->loop.last.running_ns) : std::nullopt, picture_, facts_);
  if (is_new) {
    if (texture_->load(picture_, std::max(shown_width_, 1))) list_objects();
    follow_choices(film_before);
    // Another stream, or the same from the beginning: what was learnt is not of it.
    if (facts_.running_ns < before_ns) timeline_.forget();
  }
  feed_->want();
  if (!picture_.empty()) record(is_new);
  show_past();
}

void DebugWindow::record(bool is_new) {
  Moment now;
  now.time_s = glfwGetTime();
  now.interval_s = is_new ? facts_.interval_s : 0;
  now.speed_px_s =
      controller_speed_px_s(facts_.scene.motion, facts_.settings.axes, facts_.visible.height);
  now.wanted = facts_.scene.wrench;
  if (state_.device) {
    const TickRecord& last = state_.device->loop.last;
    now.felt = last.delivered;
    now.asked = last.wanted;
    now.wanted_span = state_.device->wanted;
    now.felt_span = state_.device->delivered;
    if (now.felt_span.ticks == 0) {
      now.wanted_span.add(last.wanted.force_N);
      now.felt_span.add(last.delivered.force_N);
    }
    now.tension_N = last.tension_N;
    now.pose = last.pose;
    now.contact = last.contact;
  } else {
    now.wanted_span.add(now.wanted.force_N);
    now.felt_span.add(now.felt.force_N);
  }
  timeline_.add(now);
  if (is_new && timeline_.wants_still(now.time_s)) keep_still(now.time_s);
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
    TickRecord& last = state_.device->loop.last;
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
  picture.max_force_N = facts_.settings.controller.max_force_N;
  picture.detail = detail_;
  if (show_relief_ && relief_) picture.relief = (ImTextureID)uintptr_t{relief_texture_->id()};
  if (state_.device) picture.touch = touch_mark(facts.touch, state_.device->loop.last);
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
  const ControllerSettings& controller = facts.settings.controller;
  shown_width_ = static_cast<int>(layout.picture.width);
  show_relief(facts.touch);
  const ShownPicture picture = shown_picture(facts);
  const Rect shown = shown_rect(layout.picture, picture, facts);
  draw_picture(brush, layout.picture, picture, facts);
  const Mouse mouse = given_mouse_ ? *given_mouse_ : read_mouse();
  use_mouse(mouse, shown, facts);
  use_objects(mouse, layout.objects);
  use_plots(mouse, layout);
  if (explains_hand(facts)) draw_hand_line(brush, shown, hand_line(hand_.hand()));
  draw_grip(brush, layout.grip, state_);
  draw_tensions(brush, layout.tensions, state_);
  draw_choices(brush, layout, mouse);
  draw_force(brush, layout.force, timeline_, controller.max_force_N);
  draw_speed(brush, layout.speed, timeline_);
  if (facts.touch.on && state_.device) {
    draw_section(brush, layout.gain, facts.touch, state_.device->loop.last);
  } else {
    draw_gain(brush, layout.gain, timeline_, controller);
  }
  if (glfwGetTime() > note_until_s_) note_.clear();
  draw_status(brush, layout.status, state_, facts, note_);
  draw_controls(brush, layout.controls, state_,
                [this](const std::string& setting, double value) { change(setting, value); });
  draw_switches(brush, layout.picture, detail_, relief_ ? &show_relief_ : nullptr);
  if (help_) draw_help(scale_);
}

void DebugWindow::draw() {
  make_current();
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
  if (save_wanted_) save();
}

void DebugWindow::present() {
  make_current();
  glfwSwapBuffers(window_);
}

Screenshot DebugWindow::screenshot() const {
  make_current();
  Screenshot shot;
  if (width_ <= 0 || height_ <= 0) return shot;
  shot.width = width_;
  shot.height = height_;
  const size_t row = 3 * static_cast<size_t>(width_);
  std::vector<uint8_t> upside_down(row * static_cast<size_t>(height_));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
  for (int y = height_ - 1; y >= 0; --y) {
    const auto first = upside_down.begin() + static_cast<ptrdiff_t>(row) * y;
    shot.rgb.insert(shot.rgb.end(), first, first + static_cast<ptrdiff_t>(row));
  }
  return shot;
}

void DebugWindow::save() {
  save_wanted_ = false;
  char path[64];
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::strftime(path, sizeof path, "spidar-window-%Y%m%d-%H%M%S.png", &local);
  const std::string problem = write_png(screenshot(), path);
  say(problem.empty() ? std::string("saved ") + path : std::string(path) + ": " + problem);
}

}  // namespace spidar
