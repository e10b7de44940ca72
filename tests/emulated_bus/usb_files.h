// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Device files of the emulated USB, as in usbfs.
#pragma once

#include <cstddef>

namespace spidar::test {

/// open(2) without emulation.
int real_open(const char* path, int flags, unsigned mode);

/// A descriptor of the device in that port, or −1 and errno.
int open_usb_file(size_t port);

/// Like ioctl(2), for a descriptor of open_usb_file(), also one that another process has passed on;
/// false when it is not one.
bool usb_ioctl(int file, unsigned long request, void* argument, int& result);

/// Call before close(2) of any descriptor.
void forget_usb_file(int file);

/// Makes all open files of the port report that the device is gone.
void disconnect_files(size_t port, int errno_first);

}  // namespace spidar::test
