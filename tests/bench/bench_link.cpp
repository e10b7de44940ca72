// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Cost of an exchange with a USB board on the host's side: libusb's synchronous calls, the
// transport's asynchronous ones, and the device with its thread, at 1 kHz on an emulated bus whose
// boards answer at once. The optional argument is the duration of each in seconds.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <libusb.h>

#include "spidar/boards/board_settings.h"
#include "spidar/protocols/sh4.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/thread_setup.h"
#include "spidar/session/device_factory.h"
#include "spidar/transports/usb_transport.h"
#include "tests/emulated_bus/bus_state.h"

namespace {

using namespace spidar;

constexpr int64_t kPeriod_ns = 1'000'000;
constexpr int64_t kDeadline_ns = 5'000'000;

/// Times exchange() once a millisecond.
template <typename Exchange>
void run(const char* what, double seconds, const Exchange& exchange) {
  LatencyHistogram times;
  int failed = 0;
  int64_t next_ns = monotonic_now_ns();
  for (int i = 0; i < static_cast<int>(1000 * seconds); ++i) {
    sleep_until_ns(next_ns += kPeriod_ns);
    const int64_t begin_ns = monotonic_now_ns();
    if (!exchange()) ++failed;
    times.add(monotonic_now_ns() - begin_ns);
  }
  const auto us = [&](double q) { return 1e-3 * static_cast<double>(times.quantile_ns(q)); };
  std::printf("%-34s median %5.0f   99 %% %5.0f   99.9 %% %5.0f   max %7.0f µs, %d failed\n", what,
              us(0.5), us(0.99), us(0.999), 1e-3 * static_cast<double>(times.max_ns()), failed);
}

void run_synchronous(double seconds) {
  libusb_context* context = nullptr;
  libusb_init(&context);
  libusb_device_handle* handle =
      libusb_open_device_with_vid_pid(context, sh4::kVendor, sh4::kProduct);
  if (!handle || libusb_claim_interface(handle, 0) != 0) throw DeviceError("no board");
  sh4::Packet out, in{};
  sh4::encode_update({}, out);
  run("libusb, synchronous", seconds, [&] {
    int sent = 0, received = 0;
    return libusb_bulk_transfer(handle, sh4::kEndpointOut, out.data(), int{sh4::kPacketSize}, &sent,
                                10) == 0 &&
           libusb_bulk_transfer(handle, sh4::kEndpointIn, in.data(), int{sh4::kPacketSize},
                                &received, 10) == 0;
  });
  libusb_close(handle);
  libusb_exit(context);
}

void run_transport(double seconds) {
  UsbTransport transport("usb", {sh4::kEndpointOut, sh4::kEndpointIn, false});
  transport.select(list_usb_devices(sh4::kVendor, sh4::kProduct).at(0));
  transport.open();
  sh4::Packet out, in{};
  sh4::encode_update({}, out);
  run("transport, both ways at once", seconds, [&] {
    return transport.exchange({out}, in, monotonic_now_ns() + kDeadline_ns).fault ==
           LinkFault::kNone;
  });
}

void run_device(double seconds) {
  BoardSettings settings;
  settings.guardian = false;
  const auto device = make_device("usb", load_profile("spidar-g6x3-v2-r"), settings);
  device->open();
  run("device, link on its own thread", seconds, [&] {
    DeviceReading reading;
    return device->exchange({}, reading) == ExchangeStatus::kOk;
  });
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 5;
  if (!(seconds > 0)) {
    std::fprintf(stderr, "bench_link: \"%s\" is not a number of seconds above 0\n", argv[1]);
    return 2;
  }
  try {
    test::plug(0, test::UsbKind::kSh4);
    std::printf("%s\n", request_real_time().detail.c_str());
    run_synchronous(seconds);
    run_transport(seconds);
    run_device(seconds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_link: %s\n", error.what());
    return 1;
  }
}
