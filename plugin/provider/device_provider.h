// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// SPIDARs for GstDeviceMonitor.
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_SPIDAR_DEVICE (gst_spidar_device_get_type())
G_DECLARE_FINAL_TYPE(GstSpidarDevice, gst_spidar_device, GST, SPIDAR_DEVICE, GstDevice)

#define GST_TYPE_SPIDAR_DEVICE_PROVIDER (gst_spidar_device_provider_get_type())
G_DECLARE_FINAL_TYPE(GstSpidarDeviceProvider, gst_spidar_device_provider, GST,
                     SPIDAR_DEVICE_PROVIDER, GstDeviceProvider)

GST_DEVICE_PROVIDER_REGISTER_DECLARE(spidardeviceprovider)

G_END_DECLS
