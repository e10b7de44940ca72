// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which profiles boards on USB get, on an emulated bus.
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "tests/spidar/bus_test.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::usb_profiles_test {
namespace {

class UsbProfiles : public BusTest {};

/// A wrong profile pulls with other forces than wanted, and where it should let go.
TEST_F(UsbProfiles, AreNoneThatNobodyHasNamed) {
  plug(0, "sh4", "A1");
  plug(1, "simple");
  for (const std::string device : {"usb:1-1", "usb:1-2", "usb:A1", "usb:5", "uart:/dev/null"}) {
    EXPECT_EQ(board_info(device).profile, "") << device;
    EXPECT_THROW(profile_for(device, ""), DeviceError) << device;
    EXPECT_EQ(profile_for(device, "spidar-g6x").name, "spidar-g6x") << device;
  }
  // Which board it is, and whether there is one, comes before its profile.
  for (const char* const device : {"usb", "usb:1-9", "uart:/dev/null,/dev/no-such-line"}) {
    const std::string text = message_of<DeviceError>([&] { profile_for(device, ""); });
    EXPECT_FALSE(text.empty()) << device;
    EXPECT_EQ(text.find("profile"), std::string::npos) << text;
  }
  // The pages list these for the SH4 and the Simple board.
  const std::string of_sh4 = without_profile(board_info("usb:1-1"));
  const std::string of_simple = without_profile(board_info("usb:1-2"));
  const auto names = [](const std::string& text, const std::string& name) {
    return text.find(" " + name + ",") != std::string::npos;
  };
  EXPECT_TRUE(names(of_sh4, "spidar-g6x3-v2-r")) << of_sh4;
  EXPECT_FALSE(names(of_sh4, "spidar-g6c")) << of_sh4;
  EXPECT_TRUE(names(of_simple, "spidar-g6c")) << of_simple;
  EXPECT_FALSE(names(of_simple, "spidar-g6x3-v2-r")) << of_simple;
  for (const std::string& text : {of_sh4, of_simple}) {
    EXPECT_TRUE(names(text, "spidar-g645")) << text;  // its source names no board
    EXPECT_FALSE(names(text, "spidar-gcc")) << text;  // needs negative volts
    EXPECT_FALSE(names(text, "spidar-g6x5-l")) << text;
  }
}

TEST_F(UsbProfiles, OfOtherBoardsAreRefused) {
  plug(0, "simple").inputs = 0x70;
  for (const std::string name : {"spidar-g6x3-v2-r", "spidar-gcc", "spidar-g6x5-l"}) {
    const std::string text = message_of<std::exception>([&] { profile_for("usb:1-1", name); });
    expect_contains(text, "profile \"" + name + "\" is for boards of the kind ");
    expect_contains(text, ", and this is usb-simple. Profiles that fit it: ");
    expect_contains(text, " spidar-g6c, ");
    EXPECT_EQ(text.find("spidar-g6x3-v2-l"), std::string::npos) << text;
  }
  // The switch is read, and so the kind known, when it is opened.
  plug(1, "sh4").inputs = 0x30;
  const Profile of_sh4 = profile_for("usb:7", "spidar-g6x3-v2-r");
  expect_contains(message_of<std::exception>([&] { make_device("usb:7", of_sh4)->open(); }),
                  "the board at 1-1 is a CyVerse USB 2.0 Simple, and profile \"spidar-g6x3-v2-r\" "
                  "is for boards of the kind usb-sh4");
  EXPECT_NO_THROW(make_device("usb:3", of_sh4, unguarded())->open());
  // A name that is no device's says how it would be named.
  expect_contains(message_of<std::exception>([] { profile_for("uart", ""); }), "write uart:PATH");
  DeviceInfo nothing;
  nothing.device = "uart";
  expect_contains(without_profile(nothing), " No profile that is known here fits it. ");
}

TEST_F(UsbProfiles, AreKeptForTheSerialNumberForWhichTheyWereConfirmed) {
  const TemporaryFolder folder;
  setenv("XDG_CONFIG_HOME", folder.path.c_str(), 1);
  plug(0, "sh4", "A1");
  plug(1, "sh4", "A2");
  plug(2, "sh4");
  remember_profile(board_info("usb:A1"), "spidar-g6x3-v2-l");
  remember_profile(board_info("usb:A2"), "mine.toml");
  remember_profile(board_info("usb:A1"), "spidar-g645");
  EXPECT_EQ(profile_for("usb:1-1", "").name, "spidar-g645");
  EXPECT_EQ(board_info("usb:A2").profile, (std::filesystem::current_path() / "mine.toml").string());
  EXPECT_THROW(remember_profile(board_info("usb:1-3"), "spidar-g6c"), DeviceError);
  EXPECT_THROW(profile_for("usb:1-3", ""), DeviceError);
  // A board of the other kind is another one, whatever its number is.
  EXPECT_EQ(remembered_profile("0cec:0203", "A1"), "");
  // What cannot be read is not overwritten.
  for (const char* text : {"A1 =", "\"0cec:0205 A1\" = 5"}) {
    std::ofstream(remembered_profiles_file()) << text;
    expect_contains(message_of<std::exception>([] { profile_for("usb:1-1", ""); }),
                    remembered_profiles_file().string());
    expect_contains(board_info("usb:1-1").note, remembered_profiles_file().string());
  }
  std::ofstream(remembered_profiles_file()) << "A1 =";
  EXPECT_THROW(remember_profile(board_info("usb:A1"), "spidar-g6c"), std::runtime_error);
  unsetenv("XDG_CONFIG_HOME");
}

}  // namespace
}  // namespace spidar::test::usb_profiles_test
