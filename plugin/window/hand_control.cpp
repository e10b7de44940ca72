// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/hand_control.h"

#include <imgui.h>
#include <limits>

namespace spidar {

Mouse read_mouse() {
  const ImGuiIO& io = ImGui::GetIO();
  Mouse mouse;
  mouse.at_px = {io.MousePos.x, io.MousePos.y};
  if (!ImGui::IsMousePosValid()) {
    mouse.at_px.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  mouse.down = io.MouseDown[0];
  mouse.shift = io.KeyShift;
  mouse.wheel = io.MouseWheel;
  mouse.taken = io.WantCaptureMouse;
  return mouse;
}

}  // namespace spidar
