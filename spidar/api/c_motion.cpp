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

bool gst_spidar_motion_set_controller(GstSpidarMotion* motion, GstSpidarController controller,
                                      GstSpidarError* error) {
  return gst_spidar::done(error, [&] {
    motion->motion.set_controller(gst_spidar::same<gst_spidar::Controller>(controller));
  });
}

bool gst_spidar_motion_set_motion(GstSpidarMotion* motion, GstSpidarFeltMotion felt,
                                  GstSpidarError* error) {
  return gst_spidar::done(
      error, [&] { motion->motion.set_motion(gst_spidar::same<gst_spidar::FeltMotion>(felt)); });
}

bool gst_spidar_motion_set_max_force(GstSpidarMotion* motion, double max_force_N,
                                     GstSpidarError* error) {
  return gst_spidar::done(error, [&] { motion->motion.set_max_force(max_force_N); });
}

bool gst_spidar_motion_set_pointer(GstSpidarMotion* motion, double x, double y,
                                   GstSpidarError* error) {
  return gst_spidar::done(error, [&] { motion->motion.set_pointer(x, y); });
}

bool gst_spidar_motion_set_gains(GstSpidarMotion* motion, double depth, double roll,
                                 GstSpidarError* error) {
  return gst_spidar::done(error, [&] { motion->motion.set_gains(depth, roll); });
}

bool gst_spidar_motion_set_alpha(GstSpidarMotion* motion, double alpha_s_px,
                                 GstSpidarError* error) {
  return gst_spidar::done(error, [&] { motion->motion.set_alpha(alpha_s_px); });
}
