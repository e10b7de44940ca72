// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Messages between a player and its window with a value in every member.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/touch/height_field.h"
#include "plugin/window/view/messages.h"

namespace spidar::test {

inline window::FrameShown some_frame() {
  window::FrameShown frame{3, 7, {}};
  DrawnFrame& report = frame.report;
  report.stamp = {3, 5, 1'234'567'890'123, 40'000'000, -1.5};
  report.film = {std::make_shared<const std::string>("/film.avi"), 4, 9};
  report.frame.interval_ns = 40 * 1'000'000;
  report.took_ns = 600'000;
  report.visible = {1, 2, 320, 240};
  report.frame.place = {{3, 4, 300, 200}, 320, 240};
  report.points.push_back({1, {60, 80}, {68, 81}, PointOwner::kObject, 4, true});
  report.lost.push_back({3.5, 4.5});
  MovingObject object;
  object.id = 4;
  object.position_px = {40, -20};
  object.size_px = {60, 61};
  object.points = 12;
  report.frame.objects.push_back(object);
  report.frame.wrench.force_N = {1, 2, 3};
  report.frame.felt_object = 4;
  report.felt = {4};
  report.turn = Orientation(3, true);
  report.motion = MotionKind::kObjects;
  report.controller = {ControlLaw::kAdaptive, 2.5, 0.02};
  report.speed_px_s = 321;
  report.click = 2;
  report.track = std::make_shared<const std::string>("/film.haptic.flac");
  report.touch.on = true;
  report.touch.pointer = {Eigen::Vector2d(0.03, 0.02), Orientation(1)};
  report.touch.stiffness_N_m = 300;
  report.touch.shading.assign(touch::HeightField::kCells, 'a');
  return frame;
}

inline window::ElementState some_state() {
  window::ElementState state;
  state.name = "motion";
  DeviceView& device = state.device.emplace();
  device.name = "sim";
  device.has_hand = true;
  device.last.running_ns = 77;
  device.last.delivered.force_N = {0.1, 0.2, 0.3};
  device.last.tension_N[3] = 2.5;
  device.last.device = DeviceState::kRunning;
  device.overruns = 6;
  device.ticks = {{1'000'000, {1, 2, 3}, {4, 5, 6}}, {2'000'000, {7, 8, 9}, {0, 1, 2}}};
  device.geometry.count = 2;
  device.geometry.exit_m[1] = {0.1, 0.2, 0.3};
  device.max_tension_N[0] = 5;
  state.settings = {
      {"controller", "help", window::Setting::Kind::kChoice, 1, 0, 0, {{0, "a"}, {1, "b"}}},
      {"max-force", "newtons", window::Setting::Kind::kNumber, 2, 0, 20, {}}};
  state.has_ended = true;
  state.presets = {"film", "gentle"};
  state.no_force = "nothing moves";
  state.rules = std::make_shared<const FeelRules>("0:01-0:02.5 object at 0.25,0.5; 0:03- camera");
  return state;
}

inline window::SaveChoices some_choices() {
  return {"/film.avi", {{1, 2, Eigen::Vector2d(0.25, 0.5)}, {3, 4, std::nullopt}}};
}

}  // namespace spidar::test
