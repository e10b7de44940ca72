// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// fill-registry ELEMENT: loads all installed plugins and writes GStreamer's registry, so that tests
// which share it find it complete. Otherwise, leaks of other plugins during the scan would be
// attributed to the first test. The exit status is 0 when the registry contains the element.
#include <cstdio>

#include <gst/gst.h>

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  if (argc != 2) {
    std::fputs("error: usage: fill-registry ELEMENT\n", stderr);
    return 2;
  }
  GstElementFactory* factory = gst_element_factory_find(argv[1]);
  if (!factory) {
    std::fprintf(stderr, "error: GStreamer finds no element %s; is GST_PLUGIN_PATH its folder?\n",
                 argv[1]);
    return 1;
  }
  gst_object_unref(factory);
}
