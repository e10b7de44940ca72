// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Settings, errors, trace, stats.
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

#include <gst/controller/gstdirectcontrolbinding.h>
#include <gst/controller/gstinterpolationcontrolsource.h>
#include <gtest/gtest.h>

#include "plugin/filter/reports/motion_message.h"
#include "plugin/properties/pointer_text.h"
#include "tests/support/element_harness.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/video_frames.h"

namespace spidar::test::properties_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

GstElement* make_element(const char* properties) {
  init_gstreamer();
  GError* error = nullptr;
  GstElement* element =
      gst_parse_launch((std::string("spidarmotion ") + properties).c_str(), &error);
  EXPECT_EQ(error, nullptr) << error->message;
  return element;
}

/// State change to READY and the text of the error posted, if any.
std::string error_at_ready(const char* properties) {
  GstElement* element = make_element(properties);
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(element, bus);
  std::string text;
  if (gst_element_set_state(element, GST_STATE_READY) == GST_STATE_CHANGE_FAILURE) {
    text = "(no message)";
    if (GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR)) {
      GError* error = nullptr;
      gst_message_parse_error(message, &error, nullptr);
      text = error->message;
      g_error_free(error);
      gst_message_unref(message);
    }
  }
  gst_element_set_state(element, GST_STATE_NULL);
  gst_object_unref(element);
  gst_object_unref(bus);
  return text;
}

TEST(Properties, ASimulatedDeviceHasAProfileOfItsOwn) {
  for (const std::string device : {"sim", "sim:sh4", "sim:simple", "sim:uart", "sim:mouse",
                                   "sim:ff", "sim:inverse3", "sim:falcon"})
    EXPECT_EQ(error_at_ready(("device=" + device).c_str()), "") << device;
  // What is asked for is not replaced.
  EXPECT_NE(error_at_ready("device=sim:sh4 profile=spidar-gcc").find("negative volts"),
            std::string::npos);
}

TEST(Properties, DefaultsAreTheDocumentedOnes) {
  GstElement* element = make_element("");
  gchar *device, *profile;
  gchar* pointer;
  gdouble max_force, alpha, min_cutoff, beta;
  gint motion;
  gint64 ts_offset;
  gboolean qos;
  g_object_get(element, "device", &device, "profile", &profile, "max-force", &max_force, "alpha",
               &alpha, "ts-offset", &ts_offset, "qos", &qos, "motion", &motion, "pointer", &pointer,
               "filter-min-cutoff", &min_cutoff, "filter-beta", &beta, nullptr);
  EXPECT_STREQ(device, "sim");
  EXPECT_EQ(profile, nullptr);
  EXPECT_EQ(max_force, 3.0);
  EXPECT_EQ(alpha, 0.01);
  EXPECT_EQ(motion, static_cast<gint>(MotionKind::kObject));
  EXPECT_STREQ(pointer, "0.5,0.5");
  EXPECT_EQ(min_cutoff, 1.0);
  EXPECT_EQ(beta, 0.08);
  EXPECT_EQ(ts_offset, 0);
  EXPECT_FALSE(qos);
  EXPECT_TRUE(gst_base_transform_is_passthrough(GST_BASE_TRANSFORM(element)));
  g_free(device);
  g_free(profile);
  g_free(pointer);
  gst_object_unref(element);
}

TEST(Properties, EverySettingReadsBackWhatWasWritten) {
  GstElement* element = make_element(
      "device=none profile=spidar-g6c controller=adaptive motion=camera pointer=0.25,1 "
      "max-force=1.5 alpha=0.02 filter-min-cutoff=4 filter-beta=0.5 depth-gain=2.5 "
      "roll-gain=0 ts-offset=-5000000 on-device-error=error "
      "post-messages=false trace=/a haptic-trace=/b");
  for (const auto& [name, text] : {std::pair{"device", "none"},
                                   {"profile", "spidar-g6c"},
                                   {"controller", "adaptive"},
                                   {"motion", "camera"},
                                   {"pointer", "0.25,1"},
                                   {"filter-min-cutoff", "4"},
                                   {"filter-beta", "0.5"},
                                   {"max-force", "1.5"},
                                   {"alpha", "0.02"},
                                   {"depth-gain", "2.5"},
                                   {"roll-gain", "0"},
                                   {"ts-offset", "-5000000"},
                                   {"on-device-error", "error"},
                                   {"post-messages", "FALSE"},
                                   {"trace", "/a"},
                                   {"haptic-trace", "/b"}}) {
    GValue value = G_VALUE_INIT, wanted = G_VALUE_INIT;
    g_object_get_property(G_OBJECT(element), name, &value);
    g_value_init(&wanted, G_VALUE_TYPE(&value));
    ASSERT_TRUE(gst_value_deserialize(&wanted, text)) << name;
    EXPECT_EQ(gst_value_compare(&value, &wanted), GST_VALUE_EQUAL) << name;
    g_value_unset(&value);
    g_value_unset(&wanted);
  }
  gst_object_unref(element);
}

/// What gst-inspect-1.0 shows of an element's own properties, those of its base classes left out.
std::vector<GParamSpec*> own_properties(GstElement* element) {
  guint count = 0;
  GParamSpec** const all = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  std::vector<GParamSpec*> own;
  for (guint i = 0; i < count; ++i) {
    if (all[i]->owner_type == G_OBJECT_TYPE(element)) own.push_back(all[i]);
  }
  g_free(all);
  return own;
}

TEST(Properties, AreFewAndEachIsExplainedInALine) {
  GstElement* element = make_element("");
  const std::vector<GParamSpec*> own = own_properties(element);
  EXPECT_LE(own.size(), 30u);
  for (GParamSpec* spec : own) {
    std::istringstream blurb(g_param_spec_get_blurb(spec));
    int words = 0;
    for (std::string word; blurb >> word;) ++words;
    EXPECT_LE(words, 25) << spec->name;
    const std::string type = g_type_name(G_PARAM_SPEC_VALUE_TYPE(spec));
    EXPECT_EQ(type.find("GstSpidarMotion"), std::string::npos) << type << " repeats the element";
  }
  gst_object_unref(element);
}

TEST(Properties, APointerIsAPlaceTheGripOrTheMouse) {
  for (const char* text : {"grip", "mouse", "0,1", "0.25,0.75"}) {
    const std::optional<Pointer> pointer = parse_pointer(text);
    ASSERT_TRUE(pointer) << text;
    EXPECT_EQ(text_of(*pointer), text);
  }
  for (const char* text :
       {"", "fixed", "0.5", "0.5,", ",0.5", "0.5;0.5", "0.5,0.5,0.5", "1.1,0", "0,-0.1", "nan,0"}) {
    EXPECT_FALSE(parse_pointer(text)) << text;
  }
}

TEST(Properties, MessagesThatNobodyReadsEnd) {
  ElementHarness h;
  h.set_caps(make_caps("GRAY8", 32, 32));
  const auto push = [&h](int n) {
    h.push(make_frame(h.info(), 0, 0), static_cast<GstClockTime>(n) * 40 * GST_MSECOND);
  };
  constexpr int kFrames = kMostUnread + 100;
  for (int n = 0; n < kFrames; ++n) push(n);
  EXPECT_EQ(h.motions().size(), static_cast<size_t>(kMostUnread));
  // Now they are read.
  push(kFrames);
  EXPECT_EQ(h.motions().size(), static_cast<size_t>(kMostUnread) + 1);
}

TEST(Properties, ForceFollowsAControllerWhilePlaying) {
  ElementHarness h("device=none controller=nonlinear alpha=0.01");
  GstControlSource* source = gst_interpolation_control_source_new();
  g_object_set(source, "mode", GST_INTERPOLATION_MODE_NONE, nullptr);
  auto* values = GST_TIMED_VALUE_CONTROL_SOURCE(source);
  // Control values are shares of the property's range, 0 … 20 N.
  gst_timed_value_control_source_set(values, 0, 2.0 / 20);
  gst_timed_value_control_source_set(values, 2 * kFrame, 4.0 / 20);
  gst_object_add_control_binding(
      GST_OBJECT(h.element()),
      gst_direct_control_binding_new(GST_OBJECT(h.element()), "max-force", source));
  gst_object_unref(source);
  h.set_caps(make_caps("GRAY8", 640, 480));
  for (int n = 0; n < 3; ++n) h.push_moved(4.0 * n, 0, static_cast<GstClockTime>(n) * kFrame);
  ASSERT_EQ(h.motions().size(), 3u);
  const auto expected = [](const MotionMessage& m, double max_force) {
    const double speed = std::hypot(m.velocity_x, m.velocity_y);
    return 2 * max_force / G_PI * std::atan(0.01 * speed);
  };
  EXPECT_NEAR(h.motions()[1].wrench.force_N.norm(), expected(h.motions()[1], 2.0), 1e-12);
  EXPECT_NEAR(h.motions()[2].wrench.force_N.norm(), expected(h.motions()[2], 4.0), 1e-12);
}

TEST(Properties, UnknownDeviceIsAnErrorAtReady) {
  EXPECT_NE(error_at_ready("device=telepathy").find("telepathy"), std::string::npos);
}

TEST(Properties, UnknownProfileIsAnErrorAtReady) {
  EXPECT_NE(error_at_ready("profile=spidar-zzz").find("spidar-zzz"), std::string::npos);
}

TEST(Properties, UnreadableProfileIsAnErrorAtReady) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "broken.toml";
  std::ofstream(file) << "name = \"x\nrest = [1,";
  const std::string error = error_at_ready(("profile=" + file.string()).c_str());
  EXPECT_NE(error.find("broken.toml"), std::string::npos) << error;
}

TEST(Properties, GoodDeviceOpensAndCloses) {
  EXPECT_EQ(error_at_ready("device=sim"), "");
}

TEST(Trace, HasAHeaderAndARowAFrame) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path / "trace.csv").string();
  std::vector<MotionMessage> motions;
  {
    ElementHarness h("device=none trace=" + file);
    h.set_caps(make_caps("GRAY8", 320, 240));
    for (int n = 0; n < 3; ++n) h.push_moved(2 * n, n, static_cast<GstClockTime>(n) * kFrame);
    motions = h.motions();
  }
  std::ifstream in(file);
  std::string line;
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_EQ(line,
            "running_time_ns,stream_time_ns,features,tracked,velocity_x_px_s,velocity_y_px_s,"
            "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,limit,device_limit");
  for (const MotionMessage& m : motions) {
    ASSERT_TRUE(std::getline(in, line));
    const size_t last_comma = line.rfind(',');
    ASSERT_NE(last_comma, std::string::npos);
    EXPECT_EQ(line.substr(last_comma + 1), "no-device");
    const size_t comma_before = line.rfind(',', last_comma - 1);
    EXPECT_EQ(line.substr(comma_before + 1, last_comma - comma_before - 1), m.limit);
    std::vector<double> row;
    std::stringstream cells(line.substr(0, comma_before));
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    ASSERT_EQ(row.size(), 12u);
    // Written with the digits that reading back needs: equal, not near.
    EXPECT_EQ(row[0], static_cast<double>(m.running_time));
    EXPECT_EQ(row[1], static_cast<double>(m.stream_time));
    EXPECT_EQ(row[2], m.features);
    EXPECT_EQ(row[3], m.tracked);
    EXPECT_EQ(row[4], m.velocity_x);
    EXPECT_EQ(row[5], m.velocity_y);
    EXPECT_EQ(row[6], m.wrench.force_N.x());
    EXPECT_EQ(row[7], m.wrench.force_N.y());
  }
  EXPECT_FALSE(std::getline(in, line));
}

TEST(Trace, AnUnwritableFileIsAWarningAndTheVideoContinues) {
  ElementHarness h("device=none trace=/nowhere/trace.csv");
  h.set_caps(make_caps("GRAY8", 320, 240));
  EXPECT_EQ(h.push_moved(0, 0, 0), GST_FLOW_OK);
  ASSERT_EQ(h.warnings().size(), 1u);
  EXPECT_NE(h.warnings()[0].find("/nowhere/trace.csv"), std::string::npos);
}

TEST(Trace, FullDiskIsAWarningAndTheVideoGoesOn) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const TemporaryFolder folder;
  const std::string full = (folder.path / "full.csv").string();
  std::filesystem::create_symlink("/dev/full", full);
  ElementHarness h("device=none trace=" + full);
  h.set_caps(make_caps("GRAY8", 64, 64));
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(h.push_moved(0, 0, static_cast<GstClockTime>(n) * kFrame), GST_FLOW_OK);
  }
  EXPECT_EQ(h.warnings().size(), 1u);
}

TEST(Trace, AFileBehindALinkIsNotOverwritten) {
  const TemporaryFolder folder;
  const std::string kept = (folder.path / "kept.csv").string();
  const std::string link = (folder.path / "link.csv").string();
  std::ofstream(kept) << "as it was";
  std::filesystem::create_symlink(kept, link);
  ElementHarness h("device=none trace=" + link);
  h.set_caps(make_caps("GRAY8", 64, 64));
  EXPECT_EQ(h.push_moved(0, 0, 0), GST_FLOW_OK);
  ASSERT_EQ(h.warnings().size(), 1u);
  EXPECT_NE(h.warnings()[0].find("it is a link"), std::string::npos) << h.warnings()[0];
  EXPECT_EQ(std::filesystem::file_size(kept), std::string("as it was").size());
}

TEST(Trace, AnEndingThatSaysNothingIsAWarning) {
  const TemporaryFolder folder;
  const std::string path = (folder.path / "trace.txt").string();
  ElementHarness h("device=none trace=" + path);
  h.set_caps(make_caps("GRAY8", 64, 64));
  EXPECT_EQ(h.push_moved(0, 0, 0), GST_FLOW_OK);
  ASSERT_EQ(h.warnings().size(), 1u);
  EXPECT_NE(h.warnings()[0].find("neither in .csv nor in .jsonl"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path));
}

/// Pushes frames until the element warns, for ten seconds at most.
void push_until_warned(ElementHarness& h) {
  h.set_caps(make_caps("GRAY8", 64, 64));
  for (int n = 0; n < 1000 && h.warnings().empty(); ++n) {
    ASSERT_EQ(h.push_moved(0, 0, static_cast<GstClockTime>(n) * kFrame), GST_FLOW_OK);
    g_usleep(10'000);
  }
}

TEST(Trace, APipeWhoseReaderHasLeftIsAWarningAndTheVideoGoesOn) {
  const TemporaryFolder folder;
  const std::string pipe = (folder.path / "trace.csv").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const char* property : {"device=none trace=", "device=sim haptic-trace="}) {
    SCOPED_TRACE(property);
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    ASSERT_GE(reader, 0);
    ElementHarness h(property + pipe);
    close(reader);
    push_until_warned(h);
    ASSERT_EQ(h.warnings().size(), 1u);
    EXPECT_NE(h.warnings()[0].find("can no longer be written"), std::string::npos);
  }
}

TEST(HapticTrace, AnUnwritableFileIsAWarningAndTheForceContinues) {
  ElementHarness h("device=sim haptic-trace=/nowhere/haptic.csv");
  ASSERT_EQ(h.warnings().size(), 1u);
  EXPECT_NE(h.warnings()[0].find("/nowhere/haptic.csv"), std::string::npos);
  EXPECT_TRUE(h.errors().empty());
  EXPECT_NE(h.engine().output().session(), nullptr);
}

TEST(HapticTrace, FullDiskIsAWarningAndTheForceGoesOn) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  ElementHarness h("device=sim haptic-trace=/dev/full");
  push_until_warned(h);
  ASSERT_EQ(h.warnings().size(), 1u);
  EXPECT_NE(h.warnings()[0].find(g_strerror(ENOSPC)), std::string::npos);
  EXPECT_NE(h.engine().output().snapshot()->last.device, DeviceState::kLost);
}

TEST(Stats, NameTheModelOfTheBackground) {
  ElementHarness h("device=none motion=camera");
  h.set_caps(make_caps("GRAY8", 320, 240));
  for (int n = 0; n < 3; ++n) h.push_moved(3.0 * n, 0, static_cast<GstClockTime>(n) * kFrame);
  GstStructure* stats = nullptr;
  g_object_get(h.element(), "stats", &stats, nullptr);
  EXPECT_STREQ(gst_structure_get_string(stats, "model"), "translation");
  guint objects = 1;
  EXPECT_TRUE(gst_structure_get_uint(stats, "objects", &objects));
  EXPECT_EQ(objects, 0u);
  gst_structure_free(stats);
  EXPECT_LT(h.motions().back().velocity_x, 0);  // the picture goes right, the camera left
}

TEST(Stats, CountFramesAndNameTheDevice) {
  ElementHarness h("device=sim");
  h.set_caps(make_caps("GRAY8", 320, 240));
  for (int n = 0; n < 5; ++n) h.push_moved(n, 0, static_cast<GstClockTime>(n) * kFrame);
  GstStructure* stats = nullptr;
  g_object_get(h.element(), "stats", &stats, nullptr);
  guint64 frames = 0, restarts = 0;
  guint tracked = 0;
  EXPECT_TRUE(gst_structure_get(stats, "frames", G_TYPE_UINT64, &frames, "restarts", G_TYPE_UINT64,
                                &restarts, "tracked", G_TYPE_UINT, &tracked, nullptr));
  EXPECT_EQ(frames, 5u);
  EXPECT_EQ(restarts, 1u);  // the first frame
  EXPECT_GT(tracked, 20u);
  EXPECT_STREQ(gst_structure_get_string(stats, "model"), "none");  // motion=mean
  EXPECT_STREQ(gst_structure_get_string(stats, "device"), "sim");
  EXPECT_NE(gst_structure_get_string(stats, "scheduling"), nullptr);
  gst_structure_free(stats);
}

}  // namespace
}  // namespace spidar::test::properties_test
