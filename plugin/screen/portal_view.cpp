// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <filesystem>
#include <fstream>
#include <poll.h>
#include <stdexcept>
#include <system_error>

#include "plugin/screen/portal.h"
#include "plugin/screen/view.h"

namespace spidar::screen {
namespace {

namespace fs = std::filesystem;

/// What the user allowed last, as the desktop names it.
fs::path token_file() {
  return fs::path(g_get_user_state_dir()) / "gst-spidar" / "screen-token";
}

std::string read_token() {
  std::string token;
  std::getline(std::ifstream(token_file()), token);
  return token;
}

/// Without it, the desktop asks again, so a file that cannot be written is no error.
void write_token(const std::string& token) {
  std::error_code error;
  if (token.empty()) {
    fs::remove(token_file(), error);
    return;
  }
  fs::create_directories(token_file().parent_path(), error);
  fs::permissions(token_file().parent_path(), fs::perms::owner_all, error);
  std::ofstream(token_file(), std::ios::trunc) << token << '\n';
}

class PortalView : public View {
 public:
  explicit PortalView(bool is_asked) : cast_(is_asked ? "" : read_token()) {
    write_token(cast_.token());
  }

  std::string name() const override {
    return cast_.is_window() ? "the window that the desktop shares"
                             : "the screen that the desktop shares";
  }

  Ref<GstElement> make_source() override {
    // Plain bytes: a source that has others as well gives them, too, when only these are taken.
    const std::string line =
        "pipewiresrc do-timestamp=true fd=" + std::to_string(cast_.descriptor()) +
        " path=" + std::to_string(cast_.node()) + " ! capsfilter caps=video/x-raw";
    GError* error = nullptr;
    Ref<GstElement> source = sunk(gst_parse_bin_from_description(line.c_str(), TRUE, &error));
    g_clear_error(&error);
    if (source) return source;
    throw std::runtime_error(
        "GStreamer's pipewiresrc, which takes what the desktop shares, is missing: Debian has it "
        "in gstreamer1.0-pipewire");
  }

  std::string change() override {
    if (is_without_pipewire()) return "PipeWire has ended: start spidar-feel --screen again";
    return cast_.has_ended() ? "the desktop has ended the sharing" : "";
  }
  bool has_ended() const override { return cast_.has_ended() || is_without_pipewire(); }

 private:
  /// pipewiresrc waits on then.
  bool is_without_pipewire() const {
    pollfd remote{cast_.descriptor(), 0, 0};
    return poll(&remote, 1, 0) > 0;
  }

  ScreenCast cast_;
};

}  // namespace

std::unique_ptr<View> view_of_portal(bool is_asked) {
  return std::make_unique<PortalView>(is_asked);
}

}  // namespace spidar::screen
