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
    return transport.exchange({{query.data(), length}}, {answer.data(), answer.size()},
                              monotonic_now_ns() + patience_ns);
  }

  InverseService service;
  std::array<uint8_t, inverse3::kCommandSize> query{};
  std::array<uint8_t, 4096> answer{};
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
