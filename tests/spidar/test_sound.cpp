// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Vibration through a sound card that is emulated behind ALSA's library, and keeps what is heard
/// and when.
#include "spidar/devices/sound/packets.h"
#include "spidar/devices/sound/sound_cards.h"
#include "spidar/devices/sound/sound_transport.h"
#include "spidar/session/board_list.h"
#include "tests/spidar/sound_fixture.h"
#include "tests/support/felt_player.h"
#include "tests/support/messages.h"
#include "tests/support/test.h"

namespace spidar::test::sound_test {
namespace {

/// Strength of a channel, a fraction of full scale, in the period of a carrier of 100 Hz that
/// begins with each sample: by its root mean square.
std::vector<double> strengths(const std::vector<Sample>& samples, size_t channel) {
  constexpr size_t kPeriod = sound::kRate_Hz / 100;
  std::vector<double> result;
  double squares = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    const auto square = [&](size_t at) { return std::pow(samples[at].value[channel] / kFull, 2); };
    squares += square(i);
    if (i + 1 < kPeriod) continue;
    result.push_back(std::sqrt(2 * std::max(squares, 0.0) / kPeriod));
    squares -= square(i + 1 - kPeriod);
  }
  return result;
}

/// When the strength first passes half of `level`, in the middle of a period.
double middle_of_rise_ns(const std::vector<Sample>& samples, size_t channel, double level,
                         double after_ns) {
  const std::vector<double> strength = strengths(samples, channel);
  for (size_t i = 0; i < strength.size(); ++i) {
    const double at_ns = samples[i].at_ns + 0.5e9 / 100;
    if (at_ns > after_ns && strength[i] > level / 2) return at_ns;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(SoundCarrier, RampsWithoutAStep) {
  sound::Carrier carrier(120);
  std::vector<int16_t> samples;
  for (const float level : {0.F, 1.F, 1.F, 0.F, 1.F, 0.25F, 0.F, 0.F, 0.F}) {
    std::array<int16_t, sound::kBlockFrames> block{};
    carrier.write({{level}}, 1, 2, reinterpret_cast<uint8_t*>(block.data()));
    samples.insert(samples.end(), block.begin(), block.end());
  }
  // The slope of the sine at full level, and that of the steepest ramp, from 0 to 1 in a period.
  const double most = kFull * (2 * M_PI + 1) * 120 / sound::kRate_Hz + 1;
  for (size_t i = 1; i < samples.size(); ++i)
    ASSERT_LE(std::abs(samples[i] - samples[i - 1]), most) << i;
  EXPECT_EQ(samples.back(), 0);
  EXPECT_EQ(samples.front(), 0);
  EXPECT_TRUE(carrier.rests());
  EXPECT_GT(*std::max_element(samples.begin(), samples.end()), 0.99 * kFull);
}

TEST(SoundCarrier, WritesEveryWidthWithTheSameStrength) {
  for (const int bytes : {2, 3, 4}) {
    sound::Carrier carrier(100);
    std::vector<uint8_t> block(size_t{sound::kBlockFrames} * 6 * static_cast<size_t>(bytes));
    carrier.write({{0.5F}}, 6, bytes, block.data());
    carrier.write({{0.5F}}, 6, bytes, block.data());
    int most = 0;
    for (size_t i = 0; i < block.size(); i += 6 * static_cast<size_t>(bytes))
      most = std::max<int>(most, static_cast<int8_t>(block[i + static_cast<size_t>(bytes) - 1]));
    EXPECT_EQ(most, 63) << bytes;  // the highest byte of half of full scale
  }
}

/// Whatever the force does, a shaker is not pushed to one side: not by a force that changes with
/// the carrier's frequency, either.
TEST(SoundCarrier, LeavesNoConstantLevel) {
  for (const int carrier_Hz : {20, 47, 50, 70, 120}) {
    for (const double force_Hz : {0.0, 1.0, carrier_Hz / 2.0, 1.0 * carrier_Hz, 50.0, 49.0}) {
      sound::Carrier carrier(carrier_Hz);
      double sum = 0, most = 0;
      constexpr int kBlocks = 400;
      for (int n = 0; n < kBlocks; ++n) {
        const double time_s = 1e-3 * sound::kBlock_ms * n;
        const auto level =
            static_cast<float>(std::fabs(std::sin(2 * M_PI * force_Hz * time_s + 1)));
        std::array<int16_t, sound::kBlockFrames> block{};
        carrier.write({{level}}, 1, 2, reinterpret_cast<uint8_t*>(block.data()));
        for (const int16_t sample : block) most = std::max(most, std::fabs(sum += sample / kFull));
      }
      // Half of a sine at full level, and what the ramps leave: at most 1/(2π) of a period in all;
      // rounding towards zero, and a period that is no whole number of frames, by half of one.
      const double period = sound::kRate_Hz / double(carrier_Hz);
      const double rounding = kBlocks * sound::kBlockFrames / kFull;
      EXPECT_LT(most, period / M_PI + period / (2 * M_PI) + rounding + 1)
          << carrier_Hz << " Hz, force at " << force_Hz;
    }
  }
}

/// The kernel gives the id of a card that was unplugged to the next one of its name.
TEST(SoundCards, OnlyTheSameOneComesBack) {
  const SoundCard shaker{"Device", "USB Audio", "hw:CARD=Device,DEV=0", "USB Audio at usb-1"};
  const SoundCard moved{"Device_1", "USB Audio", "hw:CARD=Device_1,DEV=0", "USB Audio at usb-1"};
  const SoundCard other{"Device", "USB Audio", "hw:CARD=Device,DEV=0", "USB Audio at usb-2"};
  FirstDevice first;
  const auto chosen = [&](const std::vector<SoundCard>& cards) {
    return resolve_card("sound:Device", "Device", first, cards);
  };
  EXPECT_EQ(chosen({other}).place, other.place) << "the first one is any";
  first.require("sound:Device", shaker.identity());
  EXPECT_EQ(chosen({shaker}).id, "Device");
  EXPECT_EQ(chosen({other, moved}).id, "Device_1");
  EXPECT_THROW(chosen({}), DeviceError);
  expect_contains(message_of<DeviceError>([&] { chosen({other}); }), "is another device");
}

TEST_F(Sound, IsListedAndNeverChosenByItself) {
  bool listed = false;
  for (const DeviceInfo& board : list_boards()) {
    EXPECT_NE(board.device, "sound:default");
    listed = listed || (board.device == "sound:shaker" && board.name == "Emulated shaker" &&
                        !board.note.empty());
  }
  EXPECT_TRUE(listed);
  for (const AutoDevice& device : auto_devices())
    EXPECT_NE(device.device.compare(0, 5, "sound"), 0) << device.device;
}

TEST_F(Sound, SaysWhatIsWrong) {
  struct Case {
    const char *spec, *says;
    DeviceErrorCode error;
  };
  for (const Case& wrong : {
           Case{"sound:shaeker", "no sound card \"shaeker\"; there are sound:shaker, sound:stereo",
                DeviceErrorCode::kAbsent},
           Case{"sound:default", "name the card: there are sound:shaker",
                DeviceErrorCode::kSettings},
           Case{"sound:pipewire", "whatever a server", DeviceErrorCode::kSettings},
           Case{"sound:stereo,3=x", "it has 2 channels, and channel 3", DeviceErrorCode::kSettings},
       }) {
    const auto [text, kind] = error(wrong.spec);
    EXPECT_NE(text.find(wrong.says), std::string::npos) << wrong.spec << ": " << text;
    EXPECT_EQ(kind, wrong.error) << wrong.spec;
  }
  for (const char* rest :
       {",1=x", "a,5=x", "a,0=x", "a,1=w", "a,1=", "a,1=0/0/0", "a,1=1/0", "a,1=nan/0/0",
        "a,1=1/0/0/0", "a,1=x,1=y", "a,carrier=19", "a,carrier=121", "a,carrier=40,carrier=50",
        "a,gain=0", "a,gain=101", "a,", "a,x", "a,=x"})
    EXPECT_THROW(sound::Settings::parse("sound", rest), DeviceError) << rest;
}

TEST_F(Sound, ForcesBecomeLevelsAlongTheDirections) {
  const auto settings = sound::Settings::parse("sound", "a,1=-y,3=3/4/0,4=z,gain=100");
  EXPECT_EQ(settings.channels, 4);
  const auto levels = sound::levels_of(settings, {1.5, 0.75, 9});
  EXPECT_FLOAT_EQ(levels.level[0], 0.25F) << "the sign is not felt";
  EXPECT_FLOAT_EQ(levels.level[1], 0);
  EXPECT_FLOAT_EQ(levels.level[2], (0.6F * 1.5F + 0.8F * 0.75F) / 3);
  EXPECT_FLOAT_EQ(levels.level[3], 1);
  for (const double bad : {std::nan(""), HUGE_VAL})
    for (const float level : sound::levels_of(settings, {1, bad, 0}).level) EXPECT_EQ(level, 0);
}

TEST_F(Sound, FrequencyAndStrengthAreThoseOfTheForce) {
  const auto device = grip("sound:shaker,3=x,4=y,carrier=100,gain=50");
  device->open();
  EXPECT_EQ(device->abilities().force, (std::array<bool, 3>{true, true, false}));
  push(*device, {1.5, -0.6, 0}, 700);
  device->close();
  const std::vector<Sample> samples = heard();
  // From the first to the last zero crossing of what lasts.
  std::vector<double> rising_ns;
  const double from_ns = middle_of_rise_ns(samples, 2, 0.25, 0) + 100e6;
  int16_t most = 0, most_y = 0, others = 0;
  for (size_t i = 1; i < samples.size(); ++i) {
    const Sample &last = samples[i - 1], &now = samples[i];
    if (last.at_ns < from_ns || now.at_ns > from_ns + 300e6) continue;
    if (last.value[2] < 0 && now.value[2] >= 0) rising_ns.push_back(now.at_ns);
    most = std::max(most, now.value[2]);
    most_y = std::max(most_y, now.value[3]);
    others = std::max<int16_t>({others, now.value[0], now.value[1]});
  }
  ASSERT_GT(rising_ns.size(), 10u);
  const double frequency_Hz =
      1e9 * static_cast<double>(rising_ns.size() - 1) / (rising_ns.back() - rising_ns.front());
  // A crossing is known to a frame, and the ends of the interval are two.
  EXPECT_NEAR(frequency_Hz, 100, 100 * 2 * kFrame_ns / (rising_ns.back() - rising_ns.front()));
  // Rounding; the peak is at most half a frame from a sample, where the sine is less by 2e-5.
  EXPECT_NEAR(most, kFull * 0.5 * 0.5, 2);
  EXPECT_NEAR(most_y, kFull * 0.5 * 0.2, 2);
  EXPECT_EQ(others, 0);
  std::printf("frequency %.2f Hz, strength %.4f and %.4f of full scale for 0.25 and 0.1\n",
              frequency_Hz, most / kFull, most_y / kFull);
}

/// A level is taken every 10 ms, and the ramp to it lasts as long, a period: the middle of a rise
/// is up to half of that earlier or later than the delay that is reported, and its root mean square
/// finds it to 1 ms.
TEST_F(Sound, TheReportedDelayIsTheMeasuredOne) {
  const auto device = grip("sound:shaker,1=x,carrier=100,gain=100");
  device->open();
  std::vector<double> told_ns;
  double reported_ns = 0;
  for (int step = 0; step < 12; ++step) {
    push(*device, {0, 0, 0}, 150 + 3 * step);
    told_ns.push_back(static_cast<double>(monotonic_now_ns()));
    push(*device, {1.5, 0, 0}, 100);
    reported_ns = static_cast<double>(device->reading().lag_ns);
  }
  device->close();
  const std::vector<Sample> samples = heard();
  std::vector<double> delays_ns;
  for (const double at_ns : told_ns)
    delays_ns.push_back(middle_of_rise_ns(samples, 0, 0.5, at_ns + 10e6) - at_ns);
  std::sort(delays_ns.begin(), delays_ns.end());
  const double median_ns = delays_ns[delays_ns.size() / 2];
  std::printf("delay %.1f ms (%.1f to %.1f), reported %.1f ms\n", 1e-6 * median_ns,
              1e-6 * delays_ns.front(), 1e-6 * delays_ns.back(), 1e-6 * reported_ns);
  EXPECT_NEAR(median_ns, reported_ns, 5e6 + 1e6);
  EXPECT_GE(reported_ns, kLatency_ms * kMs);
  EXPECT_LE(reported_ns, (kLatency_ms + SoundTransport::kBuffer_ms + 1) * kMs);
}

/// What a tick wants is what the film has when it will be heard, by the delay that the test above
/// measures. A tick has its own time, however late it is.
TEST_F(Sound, TheLoopTellsItEarly) {
  constexpr double kForce_N = 1.5;
  constexpr int64_t kRises_ns = 600 * kMs, kRisen_ns = 610 * kMs;
  const auto loop = std::make_unique<HapticLoop>(grip("sound:shaker,1=x,carrier=100,gain=100"));
  loop->open();
  for (const auto& [time_ns, force_N] :
       {std::pair(0 * kMs, 0.0), {kRises_ns, 0.0}, {kRisen_ns, kForce_N}})
    EXPECT_TRUE(loop->schedule(lasting({force_N, 0, 0}, time_ns)));
  const int64_t begin_ns = monotonic_now_ns();
  loop->set_playback_clock({begin_ns, 0, 1.0, true});
  int64_t now_ns = begin_ns, most_lag_ns = 0;
  for (double wanted_N = 0; wanted_N < kForce_N;) {
    sleep_until_ns(now_ns + kTick_ns);
    now_ns = monotonic_now_ns();
    const int64_t lag_ns = loop->grip().reading().lag_ns;
    most_lag_ns = std::max(most_lag_ns, lag_ns);
    loop->tick(now_ns, now_ns);
    wanted_N = loop->snapshot().last.wanted.force_N.x();
    const double way = std::clamp(static_cast<double>(now_ns - begin_ns + lag_ns - kRises_ns) /
                                      static_cast<double>(kRisen_ns - kRises_ns),
                                  0.0, 1.0);
    ASSERT_NEAR(wanted_N, kForce_N * way * way * (3 - 2 * way), 1e-9);
  }
  EXPECT_GE(most_lag_ns, kLatency_ms * kMs);
}

TEST_F(Sound, IsSilentSoonAfterTheLastForce) {
  const auto device = grip("sound:shaker,1=x,gain=100");
  device->open();
  push(*device, {3, 0, 0}, 200);
  const double last_ns = static_cast<double>(monotonic_now_ns());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  double sounding_ns = 0;
  for (const Sample& sample : heard())
    if (sample.value[0] != 0) sounding_ns = sample.at_ns;
  EXPECT_GT(sounding_ns, last_ns);  // otherwise the test shows nothing
  // The last level that is taken, the sound before it, and two periods of 50 Hz: the rest of one,
  // and the way to silence.
  const double most_ms = sound::kSilence_ms + SoundTransport::kBuffer_ms + kLatency_ms + 2 * 20;
  EXPECT_LT(sounding_ns, last_ns + 1e6 * most_ms);
  // It is heard again as soon as there are forces, and ends softly.
  push(*device, {3, 0, 0}, 200);
  device->close();
  const std::vector<Sample> samples = heard();
  EXPECT_GT(std::count_if(samples.begin(), samples.end(),
                          [&](const Sample& one) {
                            return one.value[0] != 0 && one.at_ns > last_ns + 300e6;
                          }),
            0);
  const double steepest = kFull * (2 * M_PI + 1) * 50 / sound::kRate_Hz + 1;
  for (size_t i = 1; i < samples.size(); ++i)
    ASSERT_LE(std::abs(samples[i].value[0] - samples[i - 1].value[0]), steepest) << i;
  EXPECT_LE(std::abs(samples.back().value[0]), steepest);
}

TEST_F(Sound, ACardThatGoesAwayIsLostAndComesBack) {
  const auto device = grip("sound:shaker");
  device->open();
  push(*device, {1, 0, 0}, 50);
  plug(false);
  GripCommand command = told(1);
  wait_for([&] { return device->exchange(command) == LinkFault::kGone; });
  device->close();
  EXPECT_EQ(error("sound:shaker").second, DeviceErrorCode::kAbsent);
  plug(true);
  device->open();
  wait_for([&] { return device->exchange(command) == LinkFault::kNone; });
}

}  // namespace
}  // namespace spidar::test::sound_test
