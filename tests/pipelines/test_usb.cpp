// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Pipelines with boards on an emulated USB that are pulled out and put back while a film plays.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/shared_bus.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test {
namespace {

/// Waits without a limit; the test has one.
template <typename Condition>
void wait_for(const Condition& condition) {
  while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

class UsbPipeline : public testing::TestWithParam<UsbKind> {
 protected:
  ~UsbPipeline() override { clear_bus(); }
};
INSTANTIATE_TEST_SUITE_P(, UsbPipeline, testing::Values(UsbKind::kSh4, UsbKind::kSimple),
                         [](const auto& kind) {
                           return kind.param == UsbKind::kSh4 ? "sh4" : "simple";
                         });

/// The text of the next warning; the pipeline must not fail.
std::string next_warning(GstBus* bus) {
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE,
      static_cast<GstMessageType>(GST_MESSAGE_WARNING | GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
  std::string text = GST_MESSAGE_TYPE_NAME(message);
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING) {
    GError* error = nullptr;
    gst_message_parse_warning(message, &error, nullptr);
    text = error->message;
    g_clear_error(&error);
  }
  gst_message_unref(message);
  return text;
}

/// Frames keep arriving.
void wait_for_frames(GstBus* bus, int frames) {
  gst_bus_set_flushing(bus, TRUE);
  gst_bus_set_flushing(bus, FALSE);
  while (frames > 0) {
    GstMessage* message = gst_bus_timed_pop_filtered(bus, GST_CLOCK_TIME_NONE, GST_MESSAGE_ELEMENT);
    if (gst_message_has_name(message, "spidar-motion")) --frames;
    gst_message_unref(message);
  }
}

TEST_P(UsbPipeline, PlaysOnWhenTheBoardIsPulledOutAndTakesItBack) {
  UsbPort& port = plug(0, GetParam());
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(
      "videotestsrc pattern=ball ! video/x-raw,width=160,height=120 ! "
      "spidarmotion device=usb profile=spidar-g6x3-v2-r ! fakesink sync=true",
      &error);
  ASSERT_EQ(error, nullptr) << error->message;
  GstBus* bus = gst_element_get_bus(pipeline);
  ASSERT_NE(gst_element_set_state(pipeline, GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
  wait_for([&] { return !port.at_rest(); });

  unplug(0, EPROTO);
  EXPECT_EQ(next_warning(bus),
            "The haptic device does not answer: unplugged. The video continues without it.");
  wait_for_frames(bus, 5);
  plug(0, GetParam());
  wait_for([&] { return !port.at_rest(); });
  wait_for_frames(bus, 5);

  gst_element_set_state(pipeline, GST_STATE_NULL);
  EXPECT_TRUE(port.at_rest());
  gst_object_unref(bus);
  gst_object_unref(pipeline);
}

/// A wrong profile pulls with other forces than wanted, and where it should let go.
TEST(UsbPipelines, ABoardForWhichNobodyNamedAProfileGetsNoForceAndTheVideoGoesOn) {
  const UsbPort& port = plug(0, UsbKind::kSimple);
  for (const std::string element : {"spidarmotion device=usb ! fakesink",
                                    "fakesink audiotestsrc num-buffers=3 ! audio/x-raw,rate=1000,"
                                    "channels=6,channel-mask=(bitmask)0 ! spidarsink device=usb"}) {
    GstElement* pipeline = gst_parse_launch(
        ("videotestsrc num-buffers=3 ! video/x-raw,width=160,height=120 ! " + element).c_str(),
        nullptr);
    GstBus* bus = gst_element_get_bus(pipeline);
    EXPECT_NE(gst_element_set_state(pipeline, GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    const std::string warning = next_warning(bus);
    EXPECT_NE(warning.find("usb:1-1: the motors get no force: no profile is named"),
              std::string::npos)
        << warning;
    EXPECT_NE(warning.find(" spidar-g6c, "), std::string::npos) << warning;
    EXPECT_EQ(next_warning(bus), "eos");
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(bus);
    gst_object_unref(pipeline);
  }
  EXPECT_EQ(port.updates, 0u);
  clear_bus();
}

/// A real device begins gently; a simulated one has exactly the lag of its profile.
TEST(UsbPipelines, ABoardWhoseLagNobodyMeasuredIsTouchedGently) {
  plug(0, UsbKind::kSh4);
  const auto touched_N_m = [](const std::string& device, const std::string& warning) {
    GstElement* pipeline = gst_parse_launch(
        ("videotestsrc num-buffers=3 ! video/x-raw,width=160,height=120 ! spidarmotion name=m "
         "profile=spidar-g6x3-v2-r touch=luma device=" +
         device + " ! fakesink")
            .c_str(),
        nullptr);
    GstBus* bus = gst_element_get_bus(pipeline);
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    EXPECT_EQ(next_warning(bus).substr(0, warning.size()), warning);
    GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline), "m");
    GstStructure* stats = nullptr;
    g_object_get(element, "stats", &stats, nullptr);
    double stiffness_N_m = 0;
    gst_structure_get_double(stats, "touch-stiffness", &stiffness_N_m);
    gst_structure_free(stats);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(element);
    gst_object_unref(bus);
    gst_object_unref(pipeline);
    return stiffness_N_m;
  };
  EXPECT_EQ(touched_N_m("usb", "touch-stiffness is 500 N/m, but the lag of this device"), 200);
  EXPECT_EQ(touched_N_m("sim:sh4", "eos"), 500);
  clear_bus();
}

TEST_P(UsbPipeline, TheSecondToAskForABoardGetsAnErrorAndTheFirstPlaysOn) {
  UsbPort& port = plug(0, GetParam());
  const std::string launch =
      "videotestsrc pattern=ball ! video/x-raw,width=160,height=120 ! "
      "spidarmotion device=usb profile=spidar-g6x3-v2-r ! fakesink sync=true";
  GstElement* first = gst_parse_launch(launch.c_str(), nullptr);
  GstElement* second = gst_parse_launch(launch.c_str(), nullptr);
  ASSERT_NE(gst_element_set_state(first, GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
  wait_for([&] { return !port.at_rest(); });

  EXPECT_EQ(gst_element_set_state(second, GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
  GstBus* bus = gst_element_get_bus(second);
  GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
  ASSERT_NE(message, nullptr);
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  EXPECT_NE(std::string(error->message).find("another element"), std::string::npos)
      << error->message;
  g_clear_error(&error);
  gst_message_unref(message);
  gst_object_unref(bus);
  gst_element_set_state(second, GST_STATE_NULL);
  gst_object_unref(second);

  bus = gst_element_get_bus(first);
  wait_for_frames(bus, 5);
  EXPECT_FALSE(port.at_rest());
  gst_object_unref(bus);
  gst_element_set_state(first, GST_STATE_NULL);
  EXPECT_TRUE(port.at_rest());
  gst_object_unref(first);
}

/// A playing pipeline whose film is felt on the first joystick; nullptr if it cannot play.
GstElement* play_on_stick() {
  GstElement* pipeline = gst_parse_launch(
      "videotestsrc pattern=ball motion=sweep ! video/x-raw,width=160,height=120 ! "
      "spidarmotion device=ff ! fakesink sync=true",
      nullptr);
  if (!pipeline) return nullptr;
  if (gst_element_set_state(pipeline, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) {
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
    return nullptr;
  }
  wait_for([] { return !evdev_levels(0).at_rest(); });
  return pipeline;
}

/// No limit of time: if the streaming thread waited for the device, no frame would pass until the
/// driver returns, which is after 30 frames have passed. Lateness is measured in the suite
/// `kernel`, whose time does not depend on the machine.
TEST(ForceFeedbackPipeline, NoFrameWaitsForADriverThatHangs) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  GstElement* pipeline = play_on_stick();
  ASSERT_NE(pipeline, nullptr);
  GstBus* bus = gst_element_get_bus(pipeline);

  port.hangs = true;
  wait_for([&] { return port.hanging == 1; });
  const uint64_t uploads = port.uploads;
  wait_for_frames(bus, 30);
  // Nor does the application wait when it pauses the film.
  EXPECT_NE(gst_element_set_state(pipeline, GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  EXPECT_EQ(gst_element_get_state(pipeline, nullptr, nullptr, GST_CLOCK_TIME_NONE),
            GST_STATE_CHANGE_SUCCESS);
  EXPECT_EQ(port.hanging, 1);  // all that time, one upload
  EXPECT_EQ(port.uploads, uploads);

  port.hangs = false;
  wait_for([] { return evdev_levels(0).at_rest(); });
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(bus);
  gst_object_unref(pipeline);
  clear_bus();
}

TEST(ForceFeedbackPipeline, PlaysOnWhenTheStickIsPulledOutAndTakesItBack) {
  plug_evdev(0, EvdevKind::kStick);
  GstElement* pipeline = play_on_stick();
  ASSERT_NE(pipeline, nullptr);
  GstBus* bus = gst_element_get_bus(pipeline);

  unplug_evdev(0);
  EXPECT_EQ(next_warning(bus),
            "The haptic device does not answer: unplugged. The video continues without it.");
  wait_for_frames(bus, 5);
  plug_evdev(1, EvdevKind::kStick).upload_ms = 50;
  wait_for([&] { return !evdev_levels(1).at_rest(); });
  wait_for_frames(bus, 5);

  gst_element_set_state(pipeline, GST_STATE_PAUSED);
  wait_for([&] { return evdev_levels(1).at_rest(); });
  gst_element_set_state(pipeline, GST_STATE_NULL);
  EXPECT_TRUE(evdev_levels(1).at_rest());
  EXPECT_FALSE(spidar::test::bus().evdev[1].effect[0].used);
  gst_object_unref(bus);
  gst_object_unref(pipeline);
  clear_bus();
}

TEST(ForceFeedbackPipeline, SaysOnceWhatIsNotFelt) {
  struct Case {
    EvdevKind kind;
    const char* said;
  };
  for (const auto& [kind, said] :
       {Case{EvdevKind::kPad,
             "Emulated Pad, rumble only: the strength of the force is felt, not its direction."},
        {EvdevKind::kWheel,
         "Emulated Racing Wheel at 20 % of its strength, force feedback on one axis: forces up and "
         "down are not felt."},
        {EvdevKind::kStick,
         "Emulated Stick at 20 % of its strength, force feedback on two axes."}}) {
    for (const char* element : {"spidarmotion", "spidarsink"}) {
      plug_evdev(0, kind);
      GstElement* opened = gst_element_factory_make(element, nullptr);
      ASSERT_NE(opened, nullptr);
      gst_object_ref_sink(opened);
      g_object_set(opened, "device", "ff", nullptr);
      GstBus* bus = gst_bus_new();
      gst_element_set_bus(opened, bus);
      ASSERT_EQ(gst_element_set_state(opened, GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
      gst_element_set_state(opened, GST_STATE_NULL);
      GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_INFO);
      EXPECT_NE(message, nullptr) << element;
      if (message) {
        GError* info = nullptr;
        gst_message_parse_info(message, &info, nullptr);
        EXPECT_STREQ(info->message, said) << element;
        g_clear_error(&info);
        gst_message_unref(message);
      }
      EXPECT_EQ(gst_bus_pop_filtered(bus, GST_MESSAGE_INFO), nullptr) << element;
      gst_element_set_bus(opened, nullptr);
      gst_object_unref(bus);
      gst_object_unref(opened);
      clear_bus();
    }
  }
}

#ifdef EMULATED_BUS_LIBRARY

/// gst-launch-1.0, which knows nothing of an emulated bus.
class Launch : public ChildProcess {
 public:
  Launch()
      : ChildProcess({"gst-launch-1.0", "-q", "videotestsrc", "!", "spidarmotion", "device=usb",
                      "profile=spidar-g6x3-v2-r", "!", "fakesink", "sync=true"},
                     {"LD_PRELOAD=" EMULATED_BUS_LIBRARY}) {}
};

TEST(ForceFeedbackPipeline, SaysThatThePlayerStoodStill) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  const TemporaryFolder folder;
  const std::string log = (folder.path / "log").string();
  ChildProcess launch({"sh", "-c",
                       "exec gst-launch-1.0 videotestsrc pattern=ball motion=sweep ! spidarmotion "
                       "device=ff ! fakesink sync=true >" +
                           log + " 2>&1"},
                      {"LD_PRELOAD=" EMULATED_BUS_LIBRARY});
  const auto plays = [&] {
    evdev_levels(0);  // erases the effects of a player that has closed the device
    return std::any_of(port.effect.begin(), port.effect.end(),
                       [](const EvdevPort::Effect& effect) { return effect.plays.load(); });
  };
  std::string text;
  // Again if the device was back before a frame was due, which a busy machine can delay.
  while (text.find("WARNING") == std::string::npos) {
    wait_for([&] { return !evdev_levels(0).at_rest() || !launch.lives(); });
    ASSERT_TRUE(launch.lives());
    launch.send(SIGSTOP);
    wait_for([&] { return !plays(); });  // stopped by the guardian
    launch.send(SIGCONT);
    wait_for([&] { return plays() || !launch.lives(); });
    std::ifstream file(log);
    text.assign(std::istreambuf_iterator<char>(file), {});
  }
  launch.end(SIGINT);
  EXPECT_NE(text.find("The guardian has set the haptic device to rest, because the player stood "
                      "still. The video continues without it."),
            std::string::npos)
      << text;
  clear_bus();
}

TEST_P(UsbPipeline, GstLaunchRestsTheMotorsHoweverItEnds) {
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    UsbPort& port = plug(0, GetParam());
    Launch launch;
    const auto pulls = [&] { return !port.at_rest() || !launch.lives(); };
    wait_for(pulls);
    ASSERT_TRUE(launch.lives());
    if (signal == SIGINT) {
      unplug(0);
      plug(0, GetParam());
      wait_for(pulls);
      ASSERT_TRUE(launch.lives());
    }
    launch.end(signal);
    wait_for([&] { return port.at_rest(); });
    clear_bus();
  }
}

#endif

}  // namespace
}  // namespace spidar::test
