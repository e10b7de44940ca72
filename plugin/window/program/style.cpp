// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/style.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>

namespace spidar::window {
namespace {

constexpr double kBody_px = 14, kSmall_px = 11.5, kDefaultFont_px = 13;
constexpr double kRounding_px = 6, kMargin_px = 10;

/// Where Debian, Fedora and Arch put DejaVu.
constexpr const char* kFontFolders[] = {"/usr/share/fonts/truetype/dejavu/",
                                        "/usr/share/fonts/dejavu-sans-fonts/",
                                        "/usr/share/fonts/TTF/"};

ImFont* load_font(const char* file, double size_px) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  for (const char* folder : kFontFolders) {
    const std::string path = std::string(folder) + file;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) continue;
    if (ImFont* font =
            atlas.AddFontFromFileTTF(path.c_str(), static_cast<float>(std::round(size_px)))) {
      return font;
    }
  }
  // The font is drawn for 13 pixels and their multiples.
  ImFontConfig font;
  font.SizePixels =
      static_cast<float>(kDefaultFont_px * std::max(1.0, std::round(size_px / kDefaultFont_px)));
  return atlas.AddFontDefault(&font);
}

}  // namespace

Fonts load_fonts(double scale) {
  Fonts fonts;
  fonts.body = load_font("DejaVuSans.ttf", kBody_px * scale);
  fonts.bold = load_font("DejaVuSans-Bold.ttf", kBody_px * scale);
  fonts.small = load_font("DejaVuSans.ttf", kSmall_px * scale);
  return fonts;
}

void set_style(double scale) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();  // an earlier call may have scaled it
  ImGui::StyleColorsDark();
  style.WindowRounding = style.PopupRounding = static_cast<float>(kRounding_px);
  style.FrameRounding = style.GrabRounding = style.ScrollbarRounding = 4;
  style.ScaleAllSizes(static_cast<float>(scale));
  style.Colors[ImGuiCol_Text] = ImGui::ColorConvertU32ToFloat4(kTextColor);
  style.Colors[ImGuiCol_WindowBg] = ImGui::ColorConvertU32ToFloat4(kPanelColor);
  style.Colors[ImGuiCol_Border] = ImGui::ColorConvertU32ToFloat4(kBorderColor);
}

ImVec2 text_size(const ImFont* font, const std::string& text) {
  return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, text.data(), text.data() + text.size());
}

void draw_text(const Brush& brush, const ImFont* font, ImVec2 at, ImU32 color,
               const std::string& text) {
  // Glyphs are sharp on whole pixels.
  brush.list.AddText(font, font->FontSize, {std::round(at.x), std::round(at.y)}, color, text.data(),
                     text.data() + text.size());
}

void draw_wrapped(const Brush& brush, const ImFont* font, ImVec2 at, ImU32 color,
                  const std::string& text, float width_px) {
  const float height = font->CalcTextSizeA(font->FontSize, FLT_MAX, width_px, text.c_str()).y;
  brush.list.AddText(font, font->FontSize, {std::round(at.x), std::round(at.y - height / 2)}, color,
                     text.c_str(), nullptr, width_px);
}

void draw_text_before(const Brush& brush, const ImFont* font, ImVec2 at, ImU32 color,
                      const std::string& text) {
  draw_text(brush, font, {at.x - text_size(font, text).x, at.y}, color, text);
}

void draw_label(const Brush& brush, const ImFont* font, ImVec2 at, ImU32 color,
                const std::string& text) {
  const ImVec2 size = text_size(font, text);
  const float x = brush.px(5), y = brush.px(2);
  brush.list.AddRectFilled(at, {at.x + size.x + 2 * x, at.y + size.y + 2 * y}, kLabelColor,
                           brush.px(4));
  draw_text(brush, font, {at.x + x, at.y + y}, color, text);
}

Rect draw_panel(const Brush& brush, const Rect& panel, const std::string& title,
                const std::string& note) {
  const float rounding = brush.px(kRounding_px);
  brush.list.AddRectFilled(upper_left(panel), lower_right(panel), kPanelColor, rounding);
  brush.list.AddRect(upper_left(panel), lower_right(panel), kBorderColor, rounding);
  const double margin = kMargin_px * brush.scale, line = brush.fonts.bold->FontSize;
  brush.list.PushClipRect(upper_left(panel), lower_right(panel), true);
  const ImVec2 at = im(panel.x + margin, panel.y + 0.7 * margin);
  draw_text(brush, brush.fonts.bold, at, kTextColor, title);
  const double left = at.x + text_size(brush.fonts.bold, title).x + margin;
  if (panel.right() - margin - text_size(brush.fonts.body, note).x >= left) {
    draw_text_before(brush, brush.fonts.body, im(panel.right() - margin, at.y), kMutedColor, note);
  }
  brush.list.PopClipRect();
  Rect content = panel.inset(margin);
  const double taken = std::min(line + 0.4 * margin, content.height);
  content.y += taken;
  content.height -= taken;
  return content;
}

}  // namespace spidar::window
