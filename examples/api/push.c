/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/* Opens a device and pushes its grip to the right and to the left for a second:
 *   push [DEVICE]     sim, the simulated SPIDAR, when none is named
 * Needs nothing but libgst-spidar: cc -std=c11 push.c $(pkg-config --cflags --libs gst-spidar) */
#include <stdio.h>
#include <threads.h>
#include <time.h>

#include <gst-spidar/c-api.h>

int main(int argc, char** argv) {
  const struct timespec hundredth = {0, 10 * 1000 * 1000};
  double strongest_N = 0;
  GstSpidarError error;
  GstSpidarDevice* device = gst_spidar_device_open(argc > 1 ? argv[1] : "sim", NULL, &error);
  if (!device || !gst_spidar_device_set_limits(device, 2.0, 0.05, &error)) {
    fprintf(stderr, "push: %s\n", error.message);
    gst_spidar_device_close(device);
    return 1;
  }
  for (int i = 0; i < 100; ++i) {
    const GstSpidarWrench wrench = {{i < 50 ? 1 : -1, 0, 0}, {0, 0, 0}};
    GstSpidarWrench felt;
    if (!gst_spidar_device_push(device, &wrench, &error)) fprintf(stderr, "%s\n", error.message);
    thrd_sleep(&hundredth, NULL);
    gst_spidar_device_felt(device, &felt);
    if (felt.force_N.x > strongest_N) strongest_N = felt.force_N.x;
  }
  printf("%s: %.2f N at most\n", gst_spidar_device_name(device), strongest_N);
  gst_spidar_device_close(device);
  return 0;
}
