// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Properties of touching, and what is said of bad ones.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "plugin/filter/touch/relief_stream.h"
#include "spidar/loop/stiffness_limit.h"
#include "spidar/profiles/profile.h"
#include "tests/support/element_harness.h"
#include "tests/support/video_frames.h"

namespace spidar::test::touch_properties_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

std::vector<std::string> warnings_of(const std::string& properties) {
  ElementHarness h(properties);
  h.set_caps(make_caps("GRAY8", 320, 240));
  for (int n = 0; n < 3; ++n) h.push_moved(n, 0, static_cast<GstClockTime>(n) * kFrame);
  EXPECT_TRUE(h.errors().empty());
  return h.warnings();
}

/// Warnings and errors of the element about its properties.
TouchProperties read_back(const std::string& launch) {
  ElementHarness h(launch);
  TouchProperties read;
  gint kind;
  g_object_get(h.element(), "touch", &kind, "touch-relief", &read.relief_mm, "touch-stiffness",
               &read.stiffness_N_m, "touch-friction", &read.friction, "touch-texture",
               &read.texture, "motion-share", &read.motion_share, nullptr);
  read.kind = static_cast<TouchKind>(kind);
  return read;
}

void expect(const TouchProperties& read, const TouchProperties& wanted) {
  EXPECT_EQ(read.kind, wanted.kind);
  EXPECT_EQ(read.relief_mm, wanted.relief_mm);
  EXPECT_EQ(read.stiffness_N_m, wanted.stiffness_N_m);
  EXPECT_EQ(read.friction, wanted.friction);
  EXPECT_EQ(read.texture, wanted.texture);
  EXPECT_EQ(read.motion_share, wanted.motion_share);
}

TEST(TouchProperties, DefaultsAreTheDocumentedOnes) {
  expect(read_back("device=none"), {TouchKind::kOff, 8, 500, 0.3, 0, 0});
}

TEST(TouchProperties, ReadBackWhatWasWritten) {
  const std::string rest =
      " touch-relief=12 touch-stiffness=300 touch-friction=0.1 touch-texture=2 motion-share=0.4";
  expect(read_back("device=none touch=luma" + rest), {TouchKind::kLuma, 12, 300, 0.1, 2, 0.4});
  expect(read_back("device=none touch=depth-below" + rest),
         {TouchKind::kDepthBelow, 12, 300, 0.1, 2, 0.4});
}

TEST(TouchProperties, WithoutADeviceThereIsAWarningOnce) {
  const std::vector<std::string> warnings = warnings_of("device=none touch=luma");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("no device"), std::string::npos) << warnings[0];
  EXPECT_TRUE(warnings_of("device=none touch=off").empty());
  EXPECT_TRUE(warnings_of("device=sim touch=luma touch-stiffness=800").empty());
  EXPECT_TRUE(warnings_of("device=sim touch=depth").empty());
}

TEST(TouchProperties, ASlowDriveGetsLessStiffnessAndAWarning) {
  Profile profile = load_profile(kDefaultProfile);
  EXPECT_EQ(most_stiffness_N_m(profile), 200) << "until the lag was measured";
  profile.drive_lag_known = true;
  EXPECT_EQ(most_stiffness_N_m(profile), ContactSettings::kMostStiffness_N_m);
  profile.drive_lag_s = 0.0055;  // twice the delay of 3.5 ms
  EXPECT_NEAR(most_stiffness_N_m(profile), ContactSettings::kMostStiffness_N_m / 2, 1e-9);
  TouchProperties touch;
  touch.stiffness_N_m = 700;
  const ContactSettings contact = contact_settings(touch, profile);
  EXPECT_NEAR(contact.stiffness_N_m, 400, 1e-9);
  EXPECT_NEAR(contact.delay_s, 0.007, 1e-12);
  EXPECT_NEAR(contact.damping_N_s_m(), 1.5 * 400 * 0.007, 1e-9);
}

}  // namespace
}  // namespace spidar::test::touch_properties_test
