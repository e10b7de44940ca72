// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <X11/Xutil.h>
#include <X11/cursorfont.h>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gst/video/video.h>

#include "plugin/feel/follow/felt_element.h"
#include "plugin/feel/screen/view.h"
#include "plugin/feel/screen/x11_property.h"

namespace spidar::screen {
namespace {

/// The class of this project's own windows, which are not felt.
constexpr const char* kOwnClass = "spidar-window";

template <typename Data>
using FromX = std::unique_ptr<Data, int (*)(void*)>;

/// Returns nothing when the window does not have the property, or has it as another type.
template <typename Items>
Items property_of(Display* display, Window window, const char* name, const char* type) {
  constexpr long kMaxWords = 16'384;
  unsigned long left = 0;
  unsigned char* data = nullptr;
  Property found;
  const Atom wanted = XInternAtom(display, type, False);
  if (XGetWindowProperty(display, window, XInternAtom(display, name, False), 0, kMaxWords, False,
                         wanted, &found.type, &found.bits, &found.count, &left, &data) != Success) {
    return {};
  }
  const FromX<unsigned char> own(data, XFree);
  found.data = data;
  return items_of<Items>(found, wanted);
}

std::vector<Window> children_of(Display* display, Window window) {
  Window root = 0, parent = 0, *children = nullptr;
  unsigned count = 0;
  if (!XQueryTree(display, window, &root, &parent, &children, &count) || !children) return {};
  const FromX<Window> own(children, XFree);
  return {children, children + count};
}

bool is_of_program(Display* display, Window window) {
  return !property_of<std::vector<long>>(display, window, "WM_STATE", "WM_STATE").empty();
}

thread_local bool call_has_failed = false;

/// Sets the error handlers of all connections of the process. A call that fails because a window is
/// gone has no consequence; by default, Xlib would exit. When the server ends, the process exits,
/// and the guardian sets the motors to zero.
void handle_x11_errors() {
  XSetErrorHandler([](Display*, XErrorEvent*) {
    call_has_failed = true;
    return 0;
  });
  XSetIOErrorHandler([](Display*) -> int {
    std::fputs("spidar-feel: the screen has ended\n", stderr);
    _exit(1);
  });
}

/// Whether a call that this thread waited for has failed since the last query.
bool take_x11_failure() {
  return std::exchange(call_has_failed, false);
}

std::string title_of(Display* display, Window window) {
  for (const auto& [name, type] :
       {std::pair("_NET_WM_NAME", "UTF8_STRING"), std::pair("WM_NAME", "STRING")}) {
    const auto title = property_of<std::string>(display, window, name, type);
    if (!title.empty()) return text_of(title);
  }
  return "";
}

bool is_own(Display* display, Window window) {
  XClassHint names{nullptr, nullptr};
  if (!XGetClassHint(display, window, &names)) return false;
  const FromX<char> instance(names.res_name, XFree), name(names.res_class, XFree);
  return name && std::string(name.get()) == kOwnClass;
}

/// Windows of programs, the uppermost last; also minimised ones where a window manager lists them.
std::vector<Window> program_windows(Display* display) {
  const Window root = DefaultRootWindow(display);
  const auto listed =
      property_of<std::vector<Window>>(display, root, "_NET_CLIENT_LIST_STACKING", "WINDOW");
  return listed.empty() ? children_of(display, root) : listed;
}

/// The window of the program within `frame`, which a window manager may have put around it.
Window program_window_in(Display* display, Window frame) {
  if (is_of_program(display, frame)) return frame;
  for (const Window child : children_of(display, frame)) {
    const Window found = program_window_in(display, child);
    if (is_of_program(display, found)) return found;
  }
  return frame;
}

/// Waits for a click of the left button. Returns the root window for a click beside all windows,
/// and 0 when another button was pressed, or another program has the mouse.
Window clicked_window(Display* display) {
  const Window root = DefaultRootWindow(display);
  const Cursor cross = XCreateFontCursor(display, XC_crosshair);
  Window clicked = 0;
  if (XGrabPointer(display, root, False, ButtonPressMask | ButtonReleaseMask, GrabModeAsync,
                   GrabModeAsync, None, cross, CurrentTime) == GrabSuccess) {
    XEvent event;
    do {
      XNextEvent(display, &event);
      if (event.type != ButtonPress || event.xbutton.button != Button1) continue;
      const Window frame = event.xbutton.subwindow;
      clicked = frame ? program_window_in(display, frame) : root;
    } while (event.type != ButtonRelease);
    XUngrabPointer(display, CurrentTime);
  }
  XFreeCursor(display, cross);
  XSync(display, False);
  return clicked;
}

/// The fastest films have this rate. A higher one does not improve how a game feels, and each
/// picture is copied.
constexpr int kPictures_Hz = 60;

/// The debug window gets this fraction, 1 / kOwnParts, of the screen's width and height.
constexpr int kOwnParts = 3;

/// Which part of a window is visible.
enum class WindowVisibility { kWhole, kPart, kCovered, kOutside, kHidden, kClosed };

std::string visibility_text(WindowVisibility visibility) {
  switch (visibility) {
    case WindowVisibility::kWhole:
      return "can be seen again";
    case WindowVisibility::kPart:
      return "is covered in part, and what covers it is felt in its place: move that aside";
    case WindowVisibility::kCovered:
      return "is covered by another one, which is felt in its place: bring it to the front";
    case WindowVisibility::kOutside:
      return "reaches beyond the edge of the screen, and nothing of it is felt: move it inside";
    case WindowVisibility::kHidden:
      return "is minimised or on another desktop, and nothing of it is felt: bring it back";
    case WindowVisibility::kClosed:
      break;
  }
  return "is closed";
}

void paint_black(GstVideoFrame& frame, const XWindowAttributes& part) {
  const int x = std::clamp(part.x, 0, GST_VIDEO_FRAME_WIDTH(&frame));
  const int right = std::clamp(part.x + part.width, x, GST_VIDEO_FRAME_WIDTH(&frame));
  const int y = std::clamp(part.y, 0, GST_VIDEO_FRAME_HEIGHT(&frame));
  const int bottom = std::clamp(part.y + part.height, y, GST_VIDEO_FRAME_HEIGHT(&frame));
  const auto pixel = static_cast<size_t>(GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, 0));
  auto* const rows = static_cast<unsigned char*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0));
  for (int row = y; row < bottom; ++row) {
    unsigned char* const begin =
        rows + static_cast<ptrdiff_t>(row) * GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0);
    std::memset(begin + static_cast<size_t>(x) * pixel, 0, static_cast<size_t>(right - x) * pixel);
  }
}

/// Uses its own connection, not that of the source.
class X11View : public View {
 public:
  using Connection = std::unique_ptr<Display, int (*)(Display*)>;

  X11View(Connection connection, Window window)
      : connection_(std::move(connection)), display_(connection_.get()), window_(window) {
    XSelectInput(display_, window, VisibilityChangeMask);
    update_state();
    window_visibility_ = window_visibility();
  }

  std::string name() const override {
    if (is_whole()) return "the whole screen";
    const std::string title = title_of(display_, window_);
    return title.empty() ? "a window without a title" : "the window \"" + title + "\"";
  }

  Ref<GstElement> make_source() override {
    GError* error = nullptr;
    const std::string line =
        "ximagesrc name=capture show-pointer=false use-damage=false xid=" +
        std::to_string(is_whole() ? 0 : window_) +
        " ! capsfilter caps=video/x-raw,framerate=" + std::to_string(kPictures_Hz) + "/1";
    Ref<GstElement> source = sunk(gst_parse_bin_from_description(line.c_str(), TRUE, &error));
    g_clear_error(&error);
    if (!source) {
      throw std::runtime_error(
          "GStreamer's ximagesrc, which reads the screen, is missing: Debian has it in "
          "gstreamer1.0-plugins-good");
    }
    const Ref<GstElement> capture(gst_bin_get_by_name(GST_BIN(source.get()), "capture"));
    const Ref<GstPad> pad(gst_element_get_static_pad(capture.get(), "src"));
    gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_BUFFER, filter_frame, this, nullptr);
    return source;
  }

  std::string change() override {
    update_state();
    const WindowVisibility seen = window_visibility();
    if (std::exchange(window_visibility_, seen) == seen) return "";
    return name_ + " " + visibility_text(seen);
  }
  bool is_shown() const override {
    return window_visibility_ != WindowVisibility::kHidden &&
           window_visibility_ != WindowVisibility::kOutside &&
           window_visibility_ != WindowVisibility::kClosed;
  }
  bool has_ended() const override { return window_visibility_ == WindowVisibility::kClosed; }
  /// What to print at the beginning; empty: the window is visible.
  std::string initial_message() const {
    return window_visibility_ == WindowVisibility::kWhole
               ? ""
               : name_ + " " + visibility_text(window_visibility_);
  }

 private:
  bool is_whole() const { return window_ == DefaultRootWindow(display_); }

  void update_state() {
    XEvent event;
    while (XPending(display_) > 0) {
      XNextEvent(display_, &event);
      if (event.type == VisibilityNotify) visibility_ = event.xvisibility.state;
    }
    find_own();
    XWindowAttributes now{};
    if (name_.empty() || XGetWindowAttributes(display_, window_, &now)) name_ = name();
  }

  /// Whether a pixel of the window can be read: not beyond the edge of the screen, unless a
  /// compositor keeps its picture.
  bool can_read(int x, int y) const {
    XImage* const pixel = XGetImage(display_, window_, x, y, 1, 1, AllPlanes, ZPixmap);
    if (!pixel) return false;
    XDestroyImage(pixel);
    return true;
  }

  /// Whether a window of a program lies over this one. Menus and bubbles bypass the window manager
  /// and soon go by themselves, like a browser's advice to press Esc.
  bool is_covered_to_stay(const XWindowAttributes& film) const {
    const Window root = DefaultRootWindow(display_);
    int left = 0, top = 0;
    Window child = 0;
    XTranslateCoordinates(display_, window_, root, 0, 0, &left, &top, &child);
    const std::vector<Window> frames = children_of(display_, root);
    const auto is_mine = [this](Window frame) {
      return frame == window_ || program_window_in(display_, frame) == window_;
    };
    auto above = std::find_if(frames.begin(), frames.end(), is_mine);
    if (above == frames.end()) return true;
    return std::any_of(++above, frames.end(), [&](Window frame) {
      XWindowAttributes over{};
      const bool is_over = XGetWindowAttributes(display_, frame, &over) &&
                           over.map_state == IsViewable && over.x < left + film.width &&
                           over.y < top + film.height && left < over.x + over.width &&
                           top < over.y + over.height;
      return is_over && (!over.override_redirect ||
                         is_of_program(display_, program_window_in(display_, frame)));
    });
  }

  WindowVisibility window_visibility() const {
    XWindowAttributes now{};
    if (!XGetWindowAttributes(display_, window_, &now)) return WindowVisibility::kClosed;
    if (is_whole()) return WindowVisibility::kWhole;
    if (now.map_state != IsViewable) return WindowVisibility::kHidden;
    if (!can_read(0, 0) || !can_read(now.width - 1, now.height - 1)) {
      return WindowVisibility::kOutside;
    }
    if (visibility_ == VisibilityFullyObscured) return WindowVisibility::kCovered;
    const bool is_part = visibility_ == VisibilityPartiallyObscured && is_covered_to_stay(now);
    return is_part ? WindowVisibility::kPart : WindowVisibility::kWhole;
  }

  /// Moves a window that has just opened into the lower right corner of the screen: a window
  /// manager or its absence may have put it over the film, which would be hidden then.
  void move_to_corner(Window own) {
    if (!moved_.insert(own).second || !has_searched_) return;
    const int screen = DefaultScreen(display_);
    const int width = DisplayWidth(display_, screen), height = DisplayHeight(display_, screen);
    const auto side = [](int length) { return static_cast<unsigned>(length / kOwnParts); };
    XMoveResizeWindow(display_, own, width - width / kOwnParts, height - height / kOwnParts,
                      side(width), side(height));
  }

  void find_own() {
    std::vector<XWindowAttributes> found;
    for (const Window window : program_windows(display_)) {
      XWindowAttributes now{};
      Window child = 0;
      if (!is_own(display_, window) || !XGetWindowAttributes(display_, window, &now) ||
          now.map_state != IsViewable ||
          !XTranslateCoordinates(display_, window, window_, 0, 0, &now.x, &now.y, &child)) {
        continue;
      }
      move_to_corner(window);
      if (is_whole()) found.push_back(now);
    }
    has_searched_ = true;
    const std::lock_guard<std::mutex> lock(mutex_);
    own_ = std::move(found);
  }

  /// Where ximagesrc cannot read, it repeats the old content of its buffers: several old pictures
  /// in turn, whose motion would be felt, so this probe drops them. The debug window shows the film
  /// a second time, so this probe paints that window black, which is still and no film.
  static GstPadProbeReturn filter_frame(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
    if (take_x11_failure()) return GST_PAD_PROBE_DROP;
    auto& self = *static_cast<X11View*>(user);
    const std::lock_guard<std::mutex> lock(self.mutex_);
    const Ref<GstCaps> caps(gst_pad_get_current_caps(pad));
    GstVideoInfo format;
    GstVideoFrame frame;
    if (self.own_.empty() || !caps || !gst_video_info_from_caps(&format, caps.get())) {
      return GST_PAD_PROBE_OK;
    }
    GstBuffer* const buffer = gst_buffer_make_writable(GST_PAD_PROBE_INFO_BUFFER(info));
    GST_PAD_PROBE_INFO_DATA(info) = buffer;
    if (!gst_video_frame_map(&frame, &format, buffer, GST_MAP_READWRITE)) return GST_PAD_PROBE_OK;
    for (const XWindowAttributes& each : self.own_) paint_black(frame, each);
    gst_video_frame_unmap(&frame);
    return GST_PAD_PROBE_OK;
  }

  const Connection connection_;
  Display* const display_;
  const Window window_;
  std::string name_;
  int visibility_ = VisibilityUnobscured;
  WindowVisibility window_visibility_ = WindowVisibility::kWhole;
  std::set<Window> moved_;
  bool has_searched_ = false;  // windows that are open at the first search were placed by the user
  std::mutex mutex_;
  std::vector<XWindowAttributes> own_;  ///< their x and y are those on the screen
};

bool contains(const std::string& text, const std::string& part) {
  g_autofree gchar* all = g_utf8_casefold(text.c_str(), -1);
  g_autofree gchar* some = g_utf8_casefold(part.c_str(), -1);
  return std::strstr(all, some) != nullptr;
}

/// Returns the uppermost window with this title, or else with this text as a part of its title.
Window window_called(Display* display, const std::string& title) {
  Window found = 0;
  std::string others;
  bool is_exact = false;
  for (const Window window : program_windows(display)) {
    const std::string name = title_of(display, window);
    if (name.empty() || is_own(display, window)) continue;
    others += (others.empty() ? "\"" : ", \"") + name + "\"";
    if (name == title || (!is_exact && contains(name, title))) {
      found = window;
      is_exact = name == title;
    }
  }
  if (found) return found;
  throw std::runtime_error(
      "no window is called \"" + title + "\"; " +
      (others.empty() ? "there are none with a title" : "there are " + others));
}

Window chosen_window(Display* display, const std::string& what) {
  if (what.empty()) return DefaultRootWindow(display);
  if (what != "ask") return window_called(display, what);
  follow::print_message(
      "click on the window that is to be felt, or beside all windows for the whole screen");
  const Window clicked = clicked_window(display);
  if (clicked && !is_own(display, clicked)) return clicked;
  throw std::runtime_error(
      clicked ? "that is a window of gst-spidar itself: click on the one with the film"
              : "no window was clicked on with the left button; a part of its title chooses it, "
                "too: spidar-feel --screen=TITLE");
}

}  // namespace

std::unique_ptr<View> view_of_x11(const std::string& what) {
  XInitThreads();
  handle_x11_errors();
  X11View::Connection connection(XOpenDisplay(nullptr), XCloseDisplay);
  if (!connection) {
    const char* const name = g_getenv("DISPLAY");
    throw std::runtime_error(
        name && *name ? std::string("the screen ") + name +
                            " cannot be opened: it may belong to another user, or have ended"
                      : "there is no screen: neither WAYLAND_DISPLAY nor DISPLAY is set, as in a "
                        "remote session; run it on the desktop that shows the film");
  }
  const Window window = chosen_window(connection.get(), what);
  auto view = std::make_unique<X11View>(std::move(connection), window);
  if (const std::string words = view->initial_message(); !words.empty()) {
    follow::print_message(words);
  }
  return view;
}

}  // namespace spidar::screen
