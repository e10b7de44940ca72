// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Pictures in the memory of a graphics card. Mesa's software renderer will do, without a display.
#include <string>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/pipelines/launched.h"

namespace spidar::test::gl_test {
namespace {

constexpr int kFrames = 10;
const std::string kFilm = "videotestsrc pattern=ball num-buffers=" + std::to_string(kFrames) +
                          " ! video/x-raw,format=I420,width=320,height=240,framerate=25/1 ";
const std::string kMotion = "! spidarmotion name=motion motion=mean filter-min-cutoff=0 ";

/// What keeps GL from working here; empty when it works.
std::string why_no_gl() {
  gst_init(nullptr, nullptr);
  for (const char* name : {"glupload", "gldownload", "glcolorconvert"}) {
    GstElementFactory* factory = gst_element_factory_find(name);
    if (!factory) return std::string("there is no ") + name + " (package gstreamer1.0-gl)";
    gst_object_unref(factory);
  }
  // Nothing of this project is in it: what fails here does so for others, too.
  GstElement* pipeline = gst_parse_launch(
      (kFilm + "! glupload ! glcolorconvert ! gldownload ! fakesink").c_str(), nullptr);
  const Outcome outcome = run_to_end(pipeline);
  return outcome.eos ? "" : "GL does not work here: " + outcome.error;
}

class Gl : public testing::Test {
 protected:
  void SetUp() override {
    static const std::string why_not = why_no_gl();
    if (!why_not.empty()) GTEST_SKIP() << why_not;
  }
};

TEST_F(Gl, WhatIsDownloadedIsFeltAsItWas) {
  const Outcome plain = launch(kFilm + kMotion + "! fakesink");
  ASSERT_GT(plain.largest_force_N, 0);
  const Outcome downloaded = launch(
      kFilm + "! glupload ! video/x-raw(memory:GLMemory) ! gldownload " + kMotion + "! fakesink");
  EXPECT_TRUE(downloaded.eos) << downloaded.error;
  EXPECT_EQ(downloaded.motions, kFrames);
  EXPECT_EQ(downloaded.largest_force_N, plain.largest_force_N);
}

TEST_F(Gl, FramesGoOnToGlAfterwards) {
  const Outcome outcome = launch(kFilm + kMotion +
                                 "! glupload ! glcolorconvert ! "
                                 "video/x-raw(memory:GLMemory),format=RGBA ! fakesink");
  EXPECT_TRUE(outcome.eos) << outcome.error;
  EXPECT_EQ(outcome.motions, kFrames);
}

TEST_F(Gl, GlMemoryItselfIsRefusedByName) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(
      (kFilm + "! glupload ! video/x-raw(memory:GLMemory) " + kMotion + "! fakesink").c_str(),
      &error);
  ASSERT_NE(error, nullptr);
  EXPECT_EQ(error->code, GST_PARSE_ERROR_LINK);
  EXPECT_NE(std::string(error->message).find("motion"), std::string::npos) << error->message;
  g_clear_error(&error);
  if (pipeline) gst_object_unref(gst_object_ref_sink(pipeline));
}

}  // namespace
}  // namespace spidar::test::gl_test
