// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What a player and its window say to each other: as it was said, or refused.
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "plugin/window/view/channel.h"
#include "tests/support/test.h"
#include "tests/window/messages.h"

namespace spidar::test::messages_test {
namespace {

using Bytes = std::vector<uint8_t>;

std::vector<window::ToWindow> to_window_messages() {
  window::UserInput input;
  input.key = 32;
  input.mouse = window::Mouse{{1, 2}, true, false, 0.5, false};
  return {window::PictureMemory{1, "video/x-raw,format=RGB", 10, 230400},
          some_frame(),
          some_state(),
          window::ElementState(),
          window::ChoicesSaved{true, "saved"},
          window::TakePicture{"/tmp/a.png"},
          input,
          window::Close()};
}

std::vector<window::FromWindow> from_window_messages() {
  return {window::RequestFrames(),
          window::SlotFree{1, 2},
          window::ChangeSetting{"max-force", 2.5},
          window::LeadHand{Eigen::Vector3d(1, 2, 3)},
          window::LeadHand{},
          window::ChooseObject{Eigen::Vector2d(0.25, 0.5)},
          some_choices(),
          window::PlayFilm{true},
          window::SeekFilm{1'500'000'000},
          window::PictureTaken{"no room"},
          window::CannotOpen{"no display", "start one"},
          window::LoadPreset{"gentle"}};
}

TEST(Messages, AreReadAsTheyWereWritten) {
  for (const window::ToWindow& message : to_window_messages()) {
    const Bytes bytes = window::to_bytes(message);
    const std::optional<window::ToWindow> read = window::to_window(bytes);
    ASSERT_TRUE(read) << message.index();
    EXPECT_EQ(read->index(), message.index());
    EXPECT_EQ(window::to_bytes(*read), bytes) << message.index();
  }
  for (const window::FromWindow& message : from_window_messages()) {
    const Bytes bytes = window::to_bytes(message);
    const std::optional<window::FromWindow> read = window::from_window(bytes);
    ASSERT_TRUE(read) << message.index();
    EXPECT_EQ(read->index(), message.index());
    EXPECT_EQ(window::to_bytes(*read), bytes) << message.index();
  }
}

/// What to_bytes() forgets is the same in both of its results above, so some members by name.
TEST(Messages, HaveWhatIsDrawn) {
  const auto frame = std::get<window::FrameShown>(
      *window::to_window(window::to_bytes(window::ToWindow(some_frame()))));
  EXPECT_EQ(frame.slot, 7u);
  EXPECT_EQ(frame.report.film.name(), "/film.avi");
  EXPECT_EQ(frame.report.points.at(0).to.x_px, 68);
  EXPECT_EQ(frame.report.frame.objects.at(0).points, 12);
  EXPECT_EQ(frame.report.turn.to_displayed(Eigen::Vector2d(1, 0)),
            Orientation(3, true).to_displayed(Eigen::Vector2d(1, 0)));
  EXPECT_EQ(frame.report.touch.pointer.half_size_m(), Eigen::Vector2d(0.03, 0.02));
  EXPECT_EQ(frame.report.touch.shading, some_frame().report.touch.shading);
  EXPECT_EQ(frame.report.speed_px_s, 321);
  EXPECT_EQ(*frame.report.track, "/film.haptic.flac");
  const auto state = std::get<window::ElementState>(
      *window::to_window(window::to_bytes(window::ToWindow(some_state()))));
  EXPECT_EQ(state.device->last.tension_N[3], 2.5);
  EXPECT_EQ(state.device->ticks.at(1).wanted_N, Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(state.setting("controller")->choices.at(1).name, "b");
  EXPECT_EQ(state.rules->text(), some_state().rules->text());
  EXPECT_TRUE(state.has_ended);
  EXPECT_EQ(state.presets, some_state().presets);
  const auto save = std::get<window::SaveChoices>(
      *window::from_window(window::to_bytes(window::FromWindow(some_choices()))));
  EXPECT_EQ(save.edits.at(0).position, Eigen::Vector2d(0.25, 0.5));
  EXPECT_FALSE(save.edits.at(1).position);
}

TEST(Messages, ThatEndTooEarlyOrTooLateAreRefused) {
  for (const window::ToWindow& message :
       {window::ToWindow(some_frame()), window::ToWindow(some_state())}) {
    Bytes bytes = window::to_bytes(message);
    for (size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(
          window::to_window(Bytes(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size))));
    }
    bytes.push_back(0);
    EXPECT_FALSE(window::to_window(bytes));
  }
}

/// Bytes of messages, changed, cut and put together: they are refused, or are a message that can be
/// written and read again. The sanitizers say whether memory is read that is none of theirs.
TEST(Messages, ThatAreDamagedDoNoHarm) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::vector<Bytes> sources;
  for (const window::ToWindow& message : to_window_messages())
    sources.push_back(window::to_bytes(message));
  for (const window::FromWindow& message : from_window_messages())
    sources.push_back(window::to_bytes(message));
  for (int n = 0; n < 20000; ++n) {
    Bytes bytes = sources[random() % sources.size()];
    for (unsigned changes = 1 + random() % 4; changes > 0 && !bytes.empty(); --changes) {
      const size_t at = random() % bytes.size();
      constexpr std::array<uint8_t, 5> kEnds{0, 1, 127, 128, 255};
      switch (random() % 4) {
        case 0:
          bytes[at] = static_cast<uint8_t>(random());
          break;
        case 1:
          bytes[at] = kEnds[random() % kEnds.size()];
          break;
        case 2:
          bytes.resize(at);
          break;
        default: {
          const Bytes& other = sources[random() % sources.size()];
          const size_t from = random() % other.size();
          const size_t count = std::min(random() % 64, other.size() - from);
          bytes.insert(bytes.begin() + static_cast<ptrdiff_t>(at), other.begin() + from,
                       other.begin() + from + count);
        }
      }
    }
    if (const auto message = window::to_window(bytes)) {
      ASSERT_TRUE(window::to_window(window::to_bytes(*message)));
    }
    if (const auto message = window::from_window(bytes)) {
      ASSERT_EQ(window::to_bytes(*message), bytes);
    }
  }
}

TEST(Messages, ThatNoPersonAsksForAreRefused) {
  for (const window::FromWindow& message : from_window_messages()) {
    EXPECT_TRUE(window::is_possible(message)) << message.index();
  }
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_FALSE(window::is_possible(window::ChangeSetting{"max-force", bad}));
    EXPECT_FALSE(window::is_possible(window::LeadHand{Eigen::Vector3d(0, bad, 0)}));
  }
  for (const double bad : {std::nan(""), HUGE_VAL, -0.01, 1.01}) {
    const Eigen::Vector2d position(0.5, bad);
    EXPECT_FALSE(window::is_possible(window::ChooseObject{position}));
    EXPECT_FALSE(window::is_possible(window::SaveChoices{"film", {{0, 1, position}}}));
  }
  EXPECT_FALSE(window::is_possible(window::SeekFilm{-1}));
  EXPECT_FALSE(window::is_possible(window::SaveChoices{"film", {{-1, 1, std::nullopt}}}));
}

class ChannelTest : public testing::Test {
 protected:
  ChannelTest() {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
    here = std::make_unique<window::Channel>(ends[0], window::Channel::kFromPlayer);
    there = std::make_unique<window::Channel>(ends[1], window::Channel::kFromPlayer);
  }

  std::unique_ptr<window::Channel> here, there;
};

TEST_F(ChannelTest, SendsPacketsWholeAndInOrderHoweverLittleRoomThereIs) {
  constexpr size_t kLarge = 3'000'000;  // more than a socket takes at once
  here->send(Bytes(kLarge, 7));
  here->send({});
  here->send({1, 2, 3});
  EXPECT_TRUE(here->has_unsent()) << "and has not waited";
  std::vector<Bytes> got;
  while (got.size() < 3) {
    there->fill();
    while (const auto packet = there->next()) got.push_back(*packet);
    here->flush();
  }
  EXPECT_EQ(got[0], Bytes(kLarge, 7));
  EXPECT_TRUE(got[1].empty());
  EXPECT_EQ(got[2], (Bytes{1, 2, 3}));
  EXPECT_FALSE(here->has_unsent());
}

TEST_F(ChannelTest, GivesAwayACopyOfAFile) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
  here->send({1}, ends[1]);
  ::close(ends[1]);
  there->fill();
  EXPECT_TRUE(there->next());
  const int file = there->take_file();
  ASSERT_GE(file, 0);
  EXPECT_NE(fcntl(file, F_GETFD) & FD_CLOEXEC, 0) << "no other program inherits it";
  EXPECT_EQ(there->take_file(), -1);
  EXPECT_EQ(write(file, "x", 1), 1);
  ::close(file);
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 1);
  ::close(ends[0]);
}

TEST_F(ChannelTest, EndsWhenMoreComesThanItsLimits) {
  constexpr window::Channel::Limits kFew{100, 1};
  const auto is_understood = [&](size_t bytes, int files) {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
    window::Channel from(ends[0], kFew), to(ends[1], kFew);
    for (int n = 0; n < files; ++n) from.send({1}, from.socket());
    from.send(Bytes(bytes));
    to.fill();
    while (to.next()) {
    }
    return !to.is_incompatible();
  };
  EXPECT_TRUE(is_understood(100, 1));
  EXPECT_FALSE(is_understood(101, 0));
  EXPECT_FALSE(is_understood(1, 2));
}

TEST_F(ChannelTest, KnowsWhenTheOtherEndIsGone) {
  there->send({5});
  there.reset();
  here->fill();
  EXPECT_TRUE(here->is_gone());
  EXPECT_EQ(here->next(), Bytes{5}) << "what came before is not lost";
  here->send({1});  // and no signal ends this process
}

TEST_F(ChannelTest, DoesNotUnderstandAnotherVersionNorNonsense) {
  const std::string nonsense = "GET / HTTP/1.1\r\n\r\n";
  here->send({1});
  std::array<uint8_t, 64> packet{};
  const ssize_t size = read(there->socket(), packet.data(), packet.size());
  ASSERT_GT(size, 6);
  ++packet[4];  // behind the magic number: the version
  for (const auto& [bytes, count] :
       {std::pair{packet.data(), static_cast<size_t>(size)},
        {reinterpret_cast<uint8_t*>(const_cast<char*>(nonsense.data())), nonsense.size()}}) {
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    window::Channel channel(ends[1], window::Channel::kFromPlayer);
    ASSERT_EQ(write(ends[0], bytes, count), static_cast<ssize_t>(count));
    channel.fill();
    EXPECT_FALSE(channel.next());
    EXPECT_TRUE(channel.is_incompatible());
    EXPECT_TRUE(channel.is_gone());
    ::close(ends[0]);
  }
}

}  // namespace
}  // namespace spidar::test::messages_test
