// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The Inverse3 through a real WebSocket, on a service of this computer.
///
/// The process that is killed is another instance of this program.
#include <csignal>

#include "spidar/profiles/profile.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/transports/websocket_transport.h"
#include "tests/spidar/device_test.h"
#include "tests/spidar/guardian_victim.h"
#include "tests/support/inverse_service.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/test.h"

namespace spidar::test {
namespace {

std::unique_ptr<Grip> make(const std::string& spec) {
  return make_grip(spec, load_profile(kDefaultProfile));
}

/// Until the condition holds. Opens the device again when it is lost: on a busy machine, the
/// guardian may have found that this process stood still.
template <typename Condition>
void exchange_until(Grip& grip, const GripCommand& command, const Condition& condition) {
  wait_for([&] {
    if (is_lost(grip.exchange(command))) opening(grip);
    return condition();
  });
}

/// A device of the service that is open and pulls.
std::unique_ptr<Grip> pulling(InverseService& service) {
  std::unique_ptr<Grip> grip = make(service.spec("049D"));
  grip->open();
  exchange_until(*grip, told(1), [&] { return service.pulls(); });
  return grip;
}

[[noreturn]] void pull_for_ever(const std::string& spec) {
  const auto grip = make(spec);
  grip->open();
  for (;;) {
    if (!is_lost(grip->exchange(told(1)))) continue;
    grip->close();
    grip->open();
  }
}

TEST(InverseService, ForcesArriveAndPositionsComeBack) {
  InverseService service;
  inverse3::State device = InverseService::device("049D");
  device.position_m = {0.01, 0.02, -0.03};
  device.buttons = 2;
  service.plug({device});
  const auto grip = make(service.spec("049D"));
  grip->open();
  EXPECT_EQ(grip->description(), "Haply Inverse3 049D, service 3.5");
  GripCommand command = told(1, 2);
  command.wrench.force_N.z() = -0.5;
  exchange_until(*grip, command, [&] { return grip->reading().buttons == 2 && service.pulls(); });
  EXPECT_TRUE(service.force_N("049D").isApprox(Eigen::Vector3d(1, 2, -0.5), 1e-6));
  EXPECT_TRUE(grip->reading().pose.position_m.isApprox(device.position_m, 1e-9));
  const uint64_t before = grip->health().count(LinkFault::kNone);
  exchange_until(*grip, command,
                 [&] { return grip->health().count(LinkFault::kNone) >= before + 1000; });
  RecordProperty("round_trip_median_us",
                 std::to_string(grip->health().round_trip_median_ns / 1000));
  RecordProperty("round_trip_p99_us", std::to_string(grip->health().round_trip_p99_ns / 1000));
  grip->close();
  EXPECT_TRUE(service.force_N("049D").isZero(0)) << "closing ends at zero";
}

TEST(InverseService, AnAbsentOneIsNamedWithItsCure) {
  std::string spec;
  {
    InverseService service;
    spec = service.spec("049D");
  }
  const auto grip = make(spec);
  const std::string what = opening(*grip);
  EXPECT_EQ(what.find(spec + ": no service answers at localhost:"), 0u) << what;
  expect_contains(what, "start Haply's Inverse Service");
}

/// The service is on this computer, wherever the proxy is.
TEST(InverseService, NoProxyIsAsked) {
  InverseService service;
  setenv("http_proxy", "http://127.0.0.1:1", 1);
  EXPECT_EQ(opening(*make(service.spec("049D"))), "");
  unsetenv("http_proxy");
}

TEST(InverseService, WhatItLacksIsSaid) {
  InverseService service;
  const auto error = [&](const std::vector<inverse3::State>& devices) {
    service.plug(devices);
    return opening(*make(service.spec("049D")));
  };
  const std::string prefix = service.spec("049D") + ": ";
  inverse3::State device = InverseService::device("049D");
  EXPECT_EQ(error({}), prefix +
                           "Haply's service knows no Inverse3 049D: plug it in, and wait until "
                           "its light is steady");
  EXPECT_EQ(error({InverseService::device("B")}).find(prefix + "Haply's service knows no"), 0u);
  device.powered = false;
  EXPECT_EQ(error({device}), prefix + "the Inverse3 049D has no power: connect its supply");
  device.powered = true;
  device.calibrated = false;
  EXPECT_EQ(error({device}), prefix +
                                 "the Inverse3 049D is not calibrated: put its handle into the "
                                 "inkwell until its light is steady");
  service.broken = true;
  expect_contains(error({device}), "does not answer as it should");
  service.broken = false;
  EXPECT_EQ(error({InverseService::device("049D")}), "");
}

TEST(InverseService, WithoutItsPresetItIsNotUsed) {
  InverseService service;
  service.ignore("preset");
  const auto grip = make(service.spec("049D"));
  expect_contains(opening(*grip), "does not answer the beginning of a session");
  service.ignore("");
  EXPECT_EQ(opening(*grip), "");
}

TEST(InverseService, ItIsListedWhileItListens) {
  uint16_t port = 0;
  {
    const InverseService service;
    port = static_cast<uint16_t>(service.port());
    EXPECT_TRUE(is_listening(port));
    EXPECT_EQ(service.clients, 0) << "it is not asked";
  }
  EXPECT_FALSE(is_listening(port));
  const std::vector<DeviceInfo> boards = list_boards();
  const bool listed = std::any_of(boards.begin(), boards.end(), [](const DeviceInfo& board) {
    return board.device == "inverse3";
  });
  EXPECT_EQ(listed, is_listening(inverse3::kPort));
}

TEST(InverseService, AnUnpluggedDeviceIsLostUntilItIsBack) {
  InverseService service;
  const auto grip = pulling(service);
  service.plug({InverseService::device("B")});
  LinkFault status = LinkFault::kNone;
  wait_for([&] { return (status = grip->exchange(told(1))) == LinkFault::kGone; });
  EXPECT_EQ(grip->health().last_fault, LinkFault::kGone);
  EXPECT_NE(opening(*grip), "") << "the other one is not taken instead";
  service.plug({InverseService::device("B"), InverseService::device("049D")});
  EXPECT_EQ(opening(*grip), "");
}

TEST(InverseService, ItMayEndAndComeBack) {
  std::unique_ptr<InverseService> service = std::make_unique<InverseService>();
  const int port = service->port();
  const auto grip = make(service->spec("049D"));
  grip->open();
  exchange_until(*grip, told(1), [&] { return service->pulls(); });
  service.reset();
  wait_for([&] { return grip->exchange(told(1)) == LinkFault::kGone; });
  EXPECT_NE(opening(*grip), "");
  service = std::make_unique<InverseService>(port);
  EXPECT_EQ(opening(*grip), "");
  exchange_until(*grip, told(1), [&] { return service->pulls(); });
  EXPECT_TRUE(service->pulls());
}

/// Or a program whose output nobody reads would go on for ever.
TEST(InverseService, SigpipeIsLeftToTheProcess) {
  std::unique_ptr<InverseService> service = std::make_unique<InverseService>();
  const auto before = std::signal(SIGPIPE, SIG_DFL);  // the service here ignores it
  const auto grip = make(service->spec("049D"));
  grip->open();
  exchange_until(*grip, told(1), [&] { return service->pulls(); });
  service.reset();  // and what is sent after that does not end this process
  wait_for([&] { return grip->exchange(told(1)) == LinkFault::kGone; });
  grip->close();
  EXPECT_EQ(std::signal(SIGPIPE, before), SIG_DFL);
}

/// Or the forces of seconds would follow when it wakes up.
TEST(InverseService, NothingIsSentToOneThatDoesNotAnswer) {
  InverseService service;
  const auto grip = pulling(service);
  service.mute = true;
  wait_for([&] {
    grip->exchange(told(2));
    return grip->health().count(LinkFault::kTimeout) >= 3;
  });
  EXPECT_LE(service.held, 1);
}

/// The driver sends nothing before it is answered, so that the guardian does.
TEST(InverseService, ZeroIsSentToOneThatDoesNotAnswerWhenItIsClosed) {
  InverseService service;
  const auto grip = pulling(service);
  service.mute = true;
  wait_for([&] {
    return grip->exchange(told(1)) == LinkFault::kGone ||
           grip->health().count(LinkFault::kTimeout) >= 3;
  });
  grip->close();
  wait_for([&] { return !service.pulls(); });
  EXPECT_FALSE(service.pulls());
}

/// The positions of the versions differ by 0.2 m, which would be a jerk.
TEST(InverseService, AStateOfAnotherVersionIsNoPosition) {
  InverseService service;
  const auto grip = pulling(service);
  const Eigen::Vector3d before_m = grip->reading().pose.position_m;
  inverse3::State earlier = InverseService::device("049D");
  earlier.version = inverse3::Version::k31;
  earlier.position_m = {0.05, 0, 0};
  service.plug({earlier});
  exchange_until(*grip, told(1), [&] { return grip->health().count(LinkFault::kWrongReply) >= 3; });
  EXPECT_TRUE(grip->reading().pose.position_m.isApprox(before_m));
}

/// This service keeps a force for ever, so it is the guardian that ends it.
TEST(InverseService, TheGuardianEndsTheForceOfAPlayerThatIsKilledOrStopped) {
  InverseService service;
  for (const int signal : {SIGKILL, SIGSTOP}) {
    Victim victim(service.spec("049D"), "");
    for (int times = 0; times < 3 && (signal == SIGSTOP || times == 0); ++times) {
      victim.lives_until([&] { return service.pulls(); });
      const int64_t sent_ns = monotonic_now_ns();
      victim.send(signal);
      wait_for([&] { return !service.pulls(); });
      RecordProperty("force_ended_us_" + std::to_string(signal) + "_" + std::to_string(times),
                     std::to_string((service.let_go_ns - sent_ns) / 1000));
      victim.send(SIGCONT);
    }
  }
}

}  // namespace
}  // namespace spidar::test

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--pull") == 0) spidar::test::pull_for_ever(argv[2]);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
