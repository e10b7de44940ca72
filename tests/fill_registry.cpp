// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// fill-registry ELEMENT: looks at all installed plugins and writes GStreamer's registry, so that
// the tests that share it find it written. What other projects' plugins leak while they are looked
// at would else be counted as a leak of the test that comes first. The exit status is 0 when the
// registry has the element.
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
