// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/screen/x11_windows.h"

#include <X11/Xutil.h>
#include <X11/cursorfont.h>
#include <cstdio>
#include <memory>
#include <unistd.h>
#include <utility>

#include "plugin/feel/screen/x11_property.h"

namespace spidar::screen {
namespace {

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

}  // namespace

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

std::vector<Window> program_windows(Display* display) {
  const Window root = DefaultRootWindow(display);
  const auto listed =
      property_of<std::vector<Window>>(display, root, "_NET_CLIENT_LIST_STACKING", "WINDOW");
  return listed.empty() ? children_of(display, root) : listed;
}

Window program_window_in(Display* display, Window frame) {
  if (is_of_program(display, frame)) return frame;
  for (const Window child : children_of(display, frame)) {
    const Window found = program_window_in(display, child);
    if (is_of_program(display, found)) return found;
  }
  return frame;
}

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

}  // namespace spidar::screen
