// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <chrono>

#include <gst-spidar/motion.h>

#include "spidar/api/c_calls.h"

struct GstSpidarMotion {
  gst_spidar::MotionToWrench motion;
};

GstSpidarMotion* gst_spidar_motion_new(GstSpidarError* error) {
  return gst_spidar::guarded<GstSpidarMotion*>(error, nullptr, [] { return new GstSpidarMotion; });
}

void gst_spidar_motion_free(GstSpidarMotion* motion) {
  delete motion;
}

bool gst_spidar_motion_analyze(GstSpidarMotion* motion, const GstSpidarPicture* picture,
                               int64_t time_ns, GstSpidarMotionResult* result,
                               GstSpidarError* error) {
  return gst_spidar::done(error, [&] {
    *result = gst_spidar::same<GstSpidarMotionResult>(motion->motion.analyze(
        gst_spidar::same<gst_spidar::GreyPicture>(*picture), std::chrono::nanoseconds(time_ns)));
  });
}

void gst_spidar_motion_restart(GstSpidarMotion* motion) {
  motion->motion.restart();
}

void gst_spidar_motion_settings_init(GstSpidarMotionSettings* settings) {
  *settings = gst_spidar::same<GstSpidarMotionSettings>(gst_spidar::MotionSettings{});
}

bool gst_spidar_motion_configure(GstSpidarMotion* motion, const GstSpidarMotionSettings* settings,
                                 GstSpidarError* error) {
  return gst_spidar::done(error, [&] {
    motion->motion.configure(gst_spidar::same<gst_spidar::MotionSettings>(*settings));
  });
}
