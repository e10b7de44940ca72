// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/debug_window.h"

#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <imgui.h>
#include <stb/stb_image_write.h>
#include <stdexcept>

#include <GLFW/glfw3.h>

#include "spidar/part_file.h"
#include "spidar/realtime/standard_descriptors.h"

namespace spidar::window {
namespace {

/// A smaller window cuts text, at a scale of 1.
constexpr int kMinWidth = 560, kMinHeight = 380;
constexpr double kNote_s = 4;
/// After this time without a frame, the plots stop, so that the end of a film stays visible.
constexpr double kIdle_s = 1;
/// The scale of text in the coordinates of the window. If a screen has several pixels per
/// coordinate, as with Wayland, the frame buffer already has these pixels, and text needs no larger
/// scale.
double screen_scale(GLFWwindow* window) {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window, &x, &y);
  int width = 0, pixels = 0, ignored = 0;
  glfwGetWindowSize(window, &width, &ignored);
  glfwGetFramebufferSize(window, &pixels, &ignored);
  const double ratio = width > 0 && pixels > 0 ? static_cast<double>(pixels) / width : 1;
  return std::clamp(std::max(x, y) / ratio, 0.5, 8.0);
}

/// CLOCK_MONOTONIC, as in the ticks of the haptic loop.
double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The maker of pictures, for mark_written().
const std::string kMaker = "spidar-window";

/// Writes pixels of three bytes, the lowest row first. Returns an empty string, or why the file
/// cannot be written.
std::string write_png(const std::vector<uint8_t>& rgb, int width, int height,
                      const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_regular_file(path, none) && !is_as_written(path, kMaker)) {
    return "there is a file, and it is not as a debug window left it; name another file";
  }
  const int opened = open_output(path.c_str(), O_TRUNC);
  if (opened < 0) return output_reason(errno);
  std::FILE* file = fdopen(opened, "wb");
  if (!file) {
    const int error = errno;
    close(opened);
    return std::strerror(error);
  }
  stbi_flip_vertically_on_write(1);
  const auto write = [](void* to, void* data, int size) {
    std::fwrite(data, 1, static_cast<size_t>(size), static_cast<std::FILE*>(to));
  };
  const bool encoded =
      stbi_write_png_to_func(write, file, width, height, 3, rgb.data(), 3 * width) != 0;
  if (std::fflush(file) == 0) mark_written(fileno(file), kMaker);
  const bool complete = std::ferror(file) == 0;
  const bool closed = std::fclose(file) == 0;
  return encoded && complete && closed ? "" : "it cannot be written; is the disk full?";
}

}  // namespace

DebugWindow::DebugWindow(PlayerLink& link) : link_(link), state_(link.state()) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
  // spidar-feel --screen leaves out this class (kOwnClass); GLFW sets both names or none.
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "spidar-window");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "spidar-window");
  title_ = state_.name;
  window_ = glfwCreateWindow(kUsualWidth_px, kUsualHeight_px, title_.c_str(), nullptr, nullptr);
  if (!window_) {
    const char* why = nullptr;
    glfwGetError(&why);
    throw std::runtime_error(why ? why : "no window");
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(0);  // the program keeps its own pace
  ImGui::CreateContext();
  screen_scale_ = screen_scale(window_);
  glfwSetWindowSizeLimits(window_, static_cast<int>(kMinWidth * screen_scale_),
                          static_cast<int>(kMinHeight * screen_scale_), GLFW_DONT_CARE,
                          GLFW_DONT_CARE);
  ImGui::GetIO().IniFilename = nullptr;
  set_scale(screen_scale_);
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  shown_width_ = static_cast<int>(lay_out(width, height, scale_).picture.width);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (action == GLFW_RELEASE || ImGui::GetIO().WantTextInput) return;
    static_cast<DebugWindow*>(glfwGetWindowUserPointer(window))->on_key(key);
  });
  ImGui_ImplGlfw_InitForOpenGL(window_, true);  // calls the callback above, too
  ImGui_ImplOpenGL3_Init("#version 330 core");
  texture_.emplace();
  relief_.emplace();
}

/// Call this between two frames of the window.
void DebugWindow::set_scale(double scale) {
  scale_ = scale;
  ImGui::GetIO().Fonts->Clear();
  fonts_ = load_fonts(scale);
  set_style(scale);
}

DebugWindow::~DebugWindow() {
  end_choices();
  link_.lead_hand(std::nullopt);
  texture_.reset();
  relief_.reset();
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
}

bool DebugWindow::is_done() const {
  return glfwWindowShouldClose(window_) != 0;
}

void DebugWindow::show_note(const std::string& note) {
  note_ = note;
  note_until_s_ = now_s() + kNote_s;
}

/// The name of the film, or of the element where there is no file.
void DebugWindow::follow_title() {
  const std::string film = report_.film.name();
  const std::string title = film.empty() ? state_.name : film.substr(film.rfind('/') + 1);
  if (title == title_) return;
  title_ = title;
  glfwSetWindowTitle(window_, title_.c_str());
}

void DebugWindow::read() {
  state_ = link_.state();
  settings_.update(state_.settings);
  const uint32_t epoch_before = report_.stamp.epoch;
  const std::string film_before = report_.film.name();
  // Show the picture of the running time that the device renders.
  const bool plays = state_.device && state_.device->last.playing;
  std::optional<QueuedFrame> frame =
      link_.frames().show(plays ? std::optional(state_.device->last.running_ns) : std::nullopt);
  const int width = std::max(shown_width_, 1);
  if (frame) {
    picture_ = std::move(frame->picture);
    report_ = std::move(frame->report);
    frame_s_ = now_s();
    if (!report_.touch.shading.empty()) relief_->load_shading(report_.touch.shading);
  }
  if (picture_.is_there() && (frame || width != loaded_width_)) {
    loaded_width_ = width;
    texture_->load(picture_, width);
  }
  if (frame) {
    const bool is_anew = report_.stamp.epoch != epoch_before;
    if (report_.click != click_before_ || is_anew) requested_.reset();
    follow_title();
    seen_objects_.update(report_);
    follow_choices(film_before);
    // The recorded data belong to the previous stream.
    if (is_anew) timeline_.clear();
  }
  record(frame.has_value());
}

void DebugWindow::record(bool is_new) {
  const std::vector<ForceTick> ticks = link_.take_ticks();
  Moment now;
  now.time_s = now_s();
  if (!picture_.is_there() || now.time_s > frame_s_ + kIdle_s) return;
  now.interval_s = is_new ? 1e-9 * static_cast<double>(report_.frame.interval_ns) : 0;
  now.speed_px_s = report_.speed_px_s;
  now.wanted = report_.frame.wrench;
  if (state_.device) {
    now.felt = state_.device->last.delivered;
    for (const ForceTick& tick : ticks) timeline_.add(tick);
  } else {
    timeline_.add(ForceTick{static_cast<int64_t>(1e9 * now.time_s), now.wanted.force_N});
  }
  timeline_.add(now);
}

ShownPicture DebugWindow::shown_picture() const {
  ShownPicture picture;
  picture.arrow_scale = state_.value("arrow-scale", 1);
  picture.max_force_N = report_.controller.max_force_N;
  picture.detail = detail_;
  picture.requested = requested_;
  if (state_.device) {
    // The loop is between two frames; below this difference, the arrow of the frame looks the same.
    constexpr double kUnseen = 0.2;
    const Eigen::Vector3d& asked_N = report_.frame.wrench.force_N;
    const TickRecord& last = state_.device->last;
    const bool is_arrow = (last.delivered.force_N - asked_N).norm() < kUnseen * asked_N.norm();
    // Two names beside one number would be of no use.
    if ((is_arrow && are_same(last.wanted, last.delivered)) ||
        are_same(report_.frame.wrench, last.delivered)) {
      picture.delivered_N = last.delivered.force_N.norm();
    }
  }
  if (state_.device) picture.touch = touch_mark(report_.touch, state_.device->last);
  if (texture_->empty()) return picture;
  // Dear ImGui's backend for OpenGL takes the name of a texture for its identifier, which is a
  // pointer or, since 1.91.4, a number: a C cast makes either.
  picture.texture = (ImTextureID)uintptr_t{texture_->id()};
  if (!report_.touch.shading.empty()) picture.relief = (ImTextureID)uintptr_t{relief_->id()};
  picture.frame_width = texture_->frame_width();
  picture.frame_height = texture_->frame_height();
  picture.pixel_aspect = texture_->pixel_aspect();
  return picture;
}

void DebugWindow::draw_panels(int width, int height) {
  const bool has_strings = state_.device && state_.device->has_strings;
  const Layout layout =
      lay_out(width, height, scale_, {!report_.track, state_.device.has_value(), has_strings});
  const auto is_there = [](const Rect& panel) { return panel.width > 0 && panel.height > 0; };
  const Brush brush{*ImGui::GetBackgroundDrawList(), scale_, fonts_};
  const ControllerSettings& controller = report_.controller;
  shown_width_ = static_cast<int>(layout.picture.width);
  const ShownPicture picture = shown_picture();
  const Rect shown = shown_rect(layout.picture, picture, report_);
  draw_picture(brush, layout.picture, picture, report_);
  const Mouse mouse = given_mouse_ ? *given_mouse_ : read_mouse();
  use_mouse(mouse, shown);
  use_plots(mouse, layout);
  if (const std::string line = hint(); !line.empty()) draw_hint(brush, shown, line);
  if (keys_) draw_keys(brush, layout.picture);
  if (is_there(layout.grip)) {
    draw_grip(brush, layout.grip, *state_.device, picture.delivered_N.has_value());
  }
  if (is_there(layout.tensions)) draw_tensions(brush, layout.tensions, *state_.device);
  draw_choices(brush, layout.timeline);
  if (is_there(layout.force)) draw_force(brush, layout.force, timeline_);
  if (is_there(layout.speed)) {
    draw_speed(brush, layout.speed, timeline_);
    draw_gain(brush, layout.gain, timeline_, controller, settings_);
  }
  if (now_s() > note_until_s_) note_.clear();
  draw_status(brush, layout.status, state_, report_, note_);
  draw_controls_and_use(brush, layout.controls);
  draw_switches(brush, layout.picture, detail_, keys_);
}

void DebugWindow::draw() {
  glfwGetFramebufferSize(window_, &width_, &height_);
  read();
  if (width_ <= 0 || height_ <= 0) return;  // the window is minimised
  int window_width = 0, window_height = 0;
  glfwGetWindowSize(window_, &window_width, &window_height);
  const double scale = text_scale(screen_scale_, window_width, window_height);
  if (scale != scale_) {
    set_scale(scale);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
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
  const std::string error = save(path);
  show_note(error.empty() ? std::string("saved ") + path : std::string(path) + ": " + error);
}

}  // namespace spidar::window
