// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The connection to a service of this computer.
#include <malloc.h>
#include <sys/resource.h>

#include "spidar/transports/websocket_transport.h"
#include "tests/support/inverse_service.h"
#include "tests/support/test.h"

namespace spidar::test {
namespace {

class WebSockets : public testing::Test {
 protected:
  Transfer ask(int64_t patience_ns) {
    const size_t length = inverse3::encode_query(query);
    const Transfer transfer = transport.exchange(
        {{query.data(), length}}, {answer.data(), answer.size()}, monotonic_now_ns() + patience_ns);
    end = answer.data() + transfer.received;
    return transfer;
  }

  /// Of the state in the last answer.
  int number() const { return nlohmann::json::parse(answer.data(), end)["number"]; }

  InverseService service;
  std::array<uint8_t, inverse3::kCommandSize> query{};
  std::array<uint8_t, 4096> answer{};
  const uint8_t* end = nullptr;
  WebSocketTransport transport{"inverse3", static_cast<uint16_t>(service.port()), "start it"};
};

/// Nothing is sent on a connection that ended with the answer: libwebsockets has freed it, as the
/// suite `valgrind` shows.
TEST_F(WebSockets, AConnectionThatEndsWithAnAnswerIsGone) {
  transport.open();
  service.mute = true;
  ASSERT_EQ(ask(kSecond_ns / 100).fault, LinkFault::kTimeout);
  service.break_protocol();
  EXPECT_EQ(ask(10 * kSecond_ns).fault, LinkFault::kGone);
}

/// Of two answers, the second may arrive after the next message was written, and no later: the
/// first to that follows it. So no state is older than the exchange before.
TEST_F(WebSockets, WhatANewerStateHasReplacedIsDropped) {
  transport.open();
  service.answers = 2;
  int before = 0;
  for (int i = 0; i < 100; ++i) {
    const int now = service.states;
    ASSERT_EQ(ask(10 * kSecond_ns).fault, LinkFault::kShort);
    EXPECT_GT(number(), std::exchange(before, now));
  }
}

/// The answer comes after them, and after 300 exchanges without the rule.
TEST_F(WebSockets, ABurstIsDroppedAndNoFault) {
  transport.open();
  constexpr int kStates = 300;
  service.burst(kStates);
  while (service.states <= kStates) std::this_thread::yield();
  int asked = 0;
  do {
    ASSERT_EQ(ask(10 * kSecond_ns).fault, LinkFault::kShort);
    ++asked;
  } while (number() <= kStates + 1);  // and the greeting
  EXPECT_LT(asked, kStates / 2);
}

/// Nobody knows what it answers.
TEST_F(WebSockets, AServiceThatSendsMoreThanItIsAskedForIsNamed) {
  transport.open();
  service.answers = 2;
  const auto ask_until = [&](LinkFault fault) {
    for (int asked = 1;; ++asked) {
      const bool is_named = ask(10 * kSecond_ns).fault == fault;
      // Both answers have been sent, so that the next exchange finds one of them.
      while (service.unsent > 0) std::this_thread::yield();
      if (is_named) return asked;
    }
  };
  EXPECT_GE(ask_until(LinkFault::kBabble), Transport::kMaxStaleExchanges);
  transport.open();  // which does not help
  EXPECT_LT(ask_until(LinkFault::kBabble), Transport::kMaxStaleExchanges);
  service.answers = 1;
  EXPECT_LT(ask_until(LinkFault::kShort), Transport::kMaxStaleExchanges);
}

/// In a container, a process may have a billion files.
TEST_F(WebSockets, MemoryDoesNotGrowWithTheLimitOfFiles) {
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  const auto used_with = [&](rlim_t files) {
    const rlimit now{files, limit.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &now), 0);
    const struct mallinfo2 before = mallinfo2();
    transport.open();
    const struct mallinfo2 after = mallinfo2();
    transport.close();
    return static_cast<int64_t>(after.uordblks + after.hblkhd) -
           static_cast<int64_t>(before.uordblks + before.hblkhd);
  };
  constexpr rlim_t kFew = 256;
  used_with(kFew);  // what is kept from the first connection
  const int64_t few = used_with(kFew), many = used_with(limit.rlim_max);
  setrlimit(RLIMIT_NOFILE, &limit);
  // A list of the files would hold at least a pointer for each; buffers differ by some kB between
  // connections.
  EXPECT_LT(many - few, static_cast<int64_t>((limit.rlim_max - kFew) * sizeof(void*)));
}

}  // namespace
}  // namespace spidar::test
