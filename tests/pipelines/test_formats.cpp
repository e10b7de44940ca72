// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Films in the formats of decoders: 8, 10 and 12 bits, any chroma subsampling, grey of 16 bits,
// video range and full range; and as videorate repeats them. The force is that of the plain 8-bit
// film.
#include <string>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

namespace spidar::test::formats_test {
namespace {

constexpr int kFrames = 30;
const std::string kFilm = "videotestsrc pattern=ball num-buffers=" + std::to_string(kFrames) +
                          " ! video/x-raw,format=I420,width=320,height=240,framerate=25/1,"
                          "colorimetry=(string)2:4:16:4 "
                          "! videoconvert ! video/x-raw,";
/// So that hardly any of the difference is due to coding.
const std::string kCoded =
    " ! vp9enc end-usage=cq cq-level=4 min-quantizer=0 max-quantizer=8 "
    "cpu-used=8 deadline=1 ! decodebin ";

struct Felt {
  std::string format;  ///< that was negotiated
  std::vector<double> force_N;
  std::string error;
};

/// x and y of each frame's force.
Felt feel(const std::string& source) {
  gst_init(nullptr, nullptr);
  Felt felt;
  GError* problem = nullptr;
  GstElement* pipeline = gst_parse_launch(
      (source + " ! spidarmotion name=motion device=none ! fakesink").c_str(), &problem);
  if (!pipeline || problem) {
    felt.error = problem ? problem->message : "no pipeline";
    g_clear_error(&problem);
    if (pipeline) gst_object_unref(pipeline);
    return felt;
  }
  GstBus* bus = gst_element_get_bus(pipeline);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  for (bool over = false; !over;) {
    constexpr GstClockTime kPatience = 60 * GST_SECOND;
    GstMessage* message = gst_bus_timed_pop_filtered(
        bus, kPatience,
        static_cast<GstMessageType>(GST_MESSAGE_ELEMENT | GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
    if (!message) {
      felt.error = "nothing happens";
      break;
    }
    const GstStructure* s = gst_message_get_structure(message);
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
      GError* error = nullptr;
      gst_message_parse_error(message, &error, nullptr);
      felt.error = error->message;
      g_error_free(error);
    } else if (s && gst_structure_has_name(s, "spidar-motion")) {
      for (const char* axis : {"force-x", "force-y"}) {
        double force_N = 0;
        gst_structure_get_double(s, axis, &force_N);
        felt.force_N.push_back(force_N);
      }
    }
    over = GST_MESSAGE_TYPE(message) != GST_MESSAGE_ELEMENT;
    gst_message_unref(message);
  }
  GstElement* motion = gst_bin_get_by_name(GST_BIN(pipeline), "motion");
  GstPad* pad = gst_element_get_static_pad(motion, "sink");
  if (GstCaps* caps = gst_pad_get_current_caps(pad)) {
    felt.format = gst_structure_get_string(gst_caps_get_structure(caps, 0), "format");
    gst_caps_unref(caps);
  }
  gst_object_unref(pad);
  gst_object_unref(motion);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(bus);
  gst_object_unref(pipeline);
  return felt;
}

double squared(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum;
}

/// Within 5 % of the 8-bit film's, root mean square.
void expect_same_force(const Felt& felt, const Felt& plain) {
  ASSERT_EQ(felt.error, "");
  ASSERT_EQ(felt.force_N.size(), size_t{2 * kFrames});
  ASSERT_EQ(plain.force_N.size(), size_t{2 * kFrames});
  std::vector<double> difference;
  for (size_t i = 0; i < plain.force_N.size(); ++i) {
    difference.push_back(felt.force_N[i] - plain.force_N[i]);
  }
  constexpr double kLeastMeanSquare_N2 = 0.25;  // there must be something to compare
  EXPECT_GT(squared(plain.force_N), kFrames * kLeastMeanSquare_N2);
  EXPECT_LT(squared(difference), 0.05 * 0.05 * squared(plain.force_N));
}

class DecodedFormats : public testing::TestWithParam<std::string> {};

TEST_P(DecodedFormats, LinkToTheElementAndAreFeltAsThe8BitFilm) {
  const Felt plain = feel(kFilm + "format=I420" + kCoded);
  const Felt felt = feel(kFilm + "format=" + GetParam() + kCoded);
  EXPECT_EQ(felt.format, GetParam()) << "read as it is decoded";
  expect_same_force(felt, plain);
}

INSTANTIATE_TEST_SUITE_P(Vp9, DecodedFormats,
                         testing::Values("I420_10LE", "I420_12LE", "I422_10LE", "I422_12LE", "Y444",
                                         "Y444_10LE", "Y444_12LE"),
                         [](const auto& p) { return p.param; });

TEST(Formats, GreyOf16BitsIsFeltAsOf8) {
  const Felt plain = feel(kFilm + "format=GRAY8 ! pngenc ! decodebin");
  const Felt felt = feel(kFilm + "format=GRAY16_BE ! pngenc ! decodebin");
  EXPECT_EQ(felt.format, "GRAY16_BE");
  expect_same_force(felt, plain);
}

TEST(Formats, FullRangeIsFeltAsVideoRange) {
  for (const std::string format : {"I420", "I420_10LE", "P010_10LE"}) {
    SCOPED_TRACE(format);
    // By way of RGB, for videoconvert of GStreamer 1.22 does not change the range alone.
    const std::string film =
        kFilm + "format=RGB ! videoconvert ! video/x-raw,format=" + format + ",colorimetry=";
    const Felt video = feel(film + "(string)2:4:16:4");
    const Felt full = feel(film + "(string)1:4:16:4");
    EXPECT_EQ(full.format, format);
    expect_same_force(full, video);
  }
}

TEST(FrameRates, WhatVideorateRepeatsIsFeltAsThePlainFilm) {
  const std::string film =
      "videotestsrc pattern=ball num-buffers=60 ! "
      "video/x-raw,format=GRAY8,width=320,height=240,framerate=24/1 ";
  const Felt plain = feel(film);
  ASSERT_EQ(plain.force_N.size(), 120u);
  for (const std::string rate : {"60/1", "30/1", "50/1"}) {
    SCOPED_TRACE(rate);
    // Of a frame that is flagged as repeated nothing is posted: both films have as many messages.
    const Felt felt = feel(film + "! videorate ! video/x-raw,framerate=" + rate);
    ASSERT_EQ(felt.error, "");
    ASSERT_GE(felt.force_N.size(), 110u);
    constexpr size_t kLearnt = 2 * 15;
    double difference = 0, whole = 0;
    for (size_t i = kLearnt; i < 110; ++i) {
      difference += (felt.force_N[i] - plain.force_N[i]) * (felt.force_N[i] - plain.force_N[i]);
      whole += plain.force_N[i] * plain.force_N[i];
    }
    EXPECT_LT(difference, 0.1 * 0.1 * whole);
    EXPECT_GT(whole, 10);
  }
}

}  // namespace
}  // namespace spidar::test::formats_test
