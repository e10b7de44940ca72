// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// GLFW for the debug window alone.
///
/// GLFW keeps its state in static variables and serves one thread of a process. If an application
/// used the same GLFW, each would get the events of the other's windows in its own thread, and
/// glfwTerminate() would close the windows of both. The plugin is therefore not linked with GLFW:
/// it loads a second copy of the library, which has static variables of its own and which no other
/// part of the process can find. Functions named as GLFW's, visible in the plugin only, lead there
/// (forwards.py), so that Dear ImGui's code for GLFW uses the copy, too.
#pragma once

#include <cstddef>
#include <string>

namespace spidar {

/// Loads the copy; nothing happens if that has been done. Empty, or why there is none. No function
/// of GLFW may be called before.
std::string load_glfw();

/// The same, and puts the addresses of its functions with these names into `functions`.
std::string load_glfw(const char* const* names, void** functions, size_t count);

}  // namespace spidar
