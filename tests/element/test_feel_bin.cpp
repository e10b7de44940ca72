// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The filter that spidar-feel gives a player, and what another thread does at the worst moment.
// This program has functions of GStreamer of its own, which let a test act in between. The thread
// that would do so is the test's own, so no time plays a part.
#include <dlfcn.h>

#include <gst/gst.h>

#include "plugin/feel/tracer/feel_bin.h"
#include "plugin/frame/stream_orientation.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace {

/// What happens at the test's own next call of a function; once.
thread_local std::function<void()> after_adding_a_probe, before_iterating,
    before_motion_changes_state;

void happen(std::function<void()>& what) {
  const std::function<void()> now = std::exchange(what, nullptr);
  if (now) now();
}

bool is_motion(GstElement* element) {
  GstElementFactory* factory = gst_element_get_factory(element);
  return factory && g_strcmp0(GST_OBJECT_NAME(factory), "spidarmotion") == 0;
}

}  // namespace

extern "C" {

gulong gst_pad_add_probe(GstPad* pad, GstPadProbeType mask, GstPadProbeCallback callback,
                         gpointer data, GDestroyNotify destroy) {
  static const auto real =
      reinterpret_cast<decltype(&gst_pad_add_probe)>(dlsym(RTLD_NEXT, "gst_pad_add_probe"));
  const gulong id = real(pad, mask, callback, data, destroy);
  happen(after_adding_a_probe);
  return id;
}

GstIteratorResult gst_iterator_next(GstIterator* iterator, GValue* element) {
  static const auto real =
      reinterpret_cast<decltype(&gst_iterator_next)>(dlsym(RTLD_NEXT, "gst_iterator_next"));
  happen(before_iterating);
  return real(iterator, element);
}

GstStateChangeReturn gst_element_set_state(GstElement* element, GstState state) {
  static const auto real =
      reinterpret_cast<decltype(&gst_element_set_state)>(dlsym(RTLD_NEXT, "gst_element_set_state"));
  // Until it is in the pipeline, its device is opened.
  if (state >= GST_STATE_PAUSED && is_motion(element)) happen(before_motion_changes_state);
  return real(element, state);
}
}

namespace spidar::test::feel_bin_test {
namespace {

/// A pipeline with the filter, frames for it, and their end.
class FeelBin : public testing::Test {
 protected:
  /// `turns`: for a player that shows pictures as they are stored.
  explicit FeelBin(bool turns = false) {
    init_gstreamer();
    pipeline_ = gst_pipeline_new(nullptr);
    bin_ = gst_spidar_feel_bin_new("device=none", turns);
    gst_bin_add(GST_BIN(pipeline_), bin_);
    source_ = GST_PAD(gst_object_ref_sink(gst_pad_new("source", GST_PAD_SRC)));
    // Without a template, a pad that has caps accepts no others.
    GstPadTemplate* any =
        gst_pad_template_new("end", GST_PAD_SINK, GST_PAD_ALWAYS, gst_caps_new_any());
    end_ = GST_PAD(gst_object_ref_sink(gst_pad_new_from_template(any, "end")));
    gst_object_unref(any);
    gst_pad_set_chain_function_full(end_, keep, this, nullptr);
    link(source_, "sink");
    link(end_, "src");
  }
  ~FeelBin() override {
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(pipeline_);
    gst_object_unref(source_);
    gst_object_unref(end_);
    gst_clear_buffer(&shown_);
  }

  void set_state(GstState state) {
    ASSERT_EQ(gst_element_set_state(pipeline_, state), GST_STATE_CHANGE_SUCCESS);
  }

  void begin_stream() {
    gst_pad_push_event(source_, gst_event_new_stream_start("film"));
    set_size(320, 240);
    begin_segment();
  }
  void begin_segment() {
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_pad_push_event(source_, gst_event_new_segment(&segment));
  }
  void begin_flush() { gst_pad_push_event(source_, gst_event_new_flush_start()); }
  void end_flush() {
    gst_pad_push_event(source_, gst_event_new_flush_stop(TRUE));
    begin_segment();
  }
  void set_size(int width, int height) {
    GstCaps* caps = make_caps("I420", width, height);
    gst_video_info_from_caps(&info_, caps);
    EXPECT_TRUE(gst_pad_push_event(source_, gst_event_new_caps(caps)));
    gst_caps_unref(caps);
  }
  void push_orientation(const char* orientation) {
    gst_pad_push_event(source_, gst_event_new_tag(gst_tag_list_new(GST_TAG_IMAGE_ORIENTATION,
                                                                   orientation, nullptr)));
  }
  GstFlowReturn push() { return push(make_frame(info_, 0, 0)); }
  GstFlowReturn push(GstBuffer* frame) {
    GST_BUFFER_PTS(frame) = 40 * GST_MSECOND * frames_++;
    return gst_pad_push(source_, frame);
  }

  /// The spidarmotion in the filter, or nullptr.
  GstElement* motion() const {
    GstElement* found = nullptr;
    for (GList* item = GST_BIN_CHILDREN(bin_); item; item = item->next)
      if (is_motion(GST_ELEMENT(item->data))) found = GST_ELEMENT(item->data);
    return found;
  }

  GstElement* pipeline_ = nullptr;
  GstElement* bin_ = nullptr;
  GstPad* end_ = nullptr;
  GstVideoInfo info_{};
  GstBuffer* shown_ = nullptr;  ///< the last frame that has passed the filter

 private:
  static GstFlowReturn keep(GstPad* pad, GstObject*, GstBuffer* frame) {
    gst_buffer_replace(&static_cast<FeelBin*>(pad->chaindata)->shown_, frame);
    gst_buffer_unref(frame);
    return GST_FLOW_OK;
  }
  void link(GstPad* pad, const char* name) {
    GstPad* other = gst_element_get_static_pad(bin_, name);
    gst_pad_set_active(pad, TRUE);
    if (GST_PAD_IS_SRC(pad))
      gst_pad_link(pad, other);
    else
      gst_pad_link(other, pad);
    gst_object_unref(other);
  }

  GstPad* source_ = nullptr;
  int frames_ = 0;
};

TEST_F(FeelBin, FramesMayChangeTheirSizeToOneThatIsNotFelt) {
  set_state(GST_STATE_PAUSED);
  begin_stream();
  EXPECT_EQ(push(), GST_FLOW_OK);
  EXPECT_EQ(motion(), nullptr);
  set_state(GST_STATE_PLAYING);
  EXPECT_EQ(push(), GST_FLOW_OK);
  GstElement* const first = motion();
  ASSERT_NE(first, nullptr);
  for (const int side : {8, 320, 8193}) {
    set_size(side, side);
    EXPECT_EQ(push(), GST_FLOW_OK);
    EXPECT_EQ(motion(), first);
  }
}

TEST_F(FeelBin, AFrameMayComeWhileThePlayerBeginsToPlay) {
  set_state(GST_STATE_PAUSED);
  begin_stream();
  EXPECT_EQ(push(), GST_FLOW_OK);
  after_adding_a_probe = [this] { EXPECT_EQ(push(), GST_FLOW_OK); };
  set_state(GST_STATE_PLAYING);
  after_adding_a_probe = nullptr;
  EXPECT_EQ(push(), GST_FLOW_OK);
  EXPECT_NE(motion(), nullptr);
  set_state(GST_STATE_READY);
  EXPECT_EQ(motion(), nullptr);
  // The next film.
  set_state(GST_STATE_PAUSED);
  begin_stream();
  EXPECT_EQ(push(), GST_FLOW_OK);
  EXPECT_EQ(motion(), nullptr);
  set_state(GST_STATE_PLAYING);
  EXPECT_EQ(push(), GST_FLOW_OK);
  EXPECT_NE(motion(), nullptr);
}

TEST_F(FeelBin, APipelineThatChangesMeanwhileIsSearchedAgain) {
  GstElement* own = gst_element_factory_make("spidarmotion", "own");
  g_object_set(own, "device", "none", nullptr);
  gst_bin_add(GST_BIN(pipeline_), own);
  set_state(GST_STATE_PAUSED);
  begin_stream();
  before_iterating = [this] { gst_bin_add(GST_BIN(pipeline_), gst_bin_new(nullptr)); };
  EXPECT_EQ(gst_element_set_state(bin_, GST_STATE_PLAYING), GST_STATE_CHANGE_SUCCESS);
  EXPECT_EQ(before_iterating, nullptr);
  EXPECT_EQ(push(), GST_FLOW_OK);
  EXPECT_EQ(motion(), nullptr);
}

/// The state of the player when the first frame puts spidarmotion in, and after that.
class FeelBinStates : public FeelBin,
                      public testing::WithParamInterface<std::pair<GstState, GstState>> {};

TEST_P(FeelBinStates, SpidarmotionFollowsAPlayerThatChangesItsStateAtThatMoment) {
  const auto [before, after] = GetParam();
  set_state(GST_STATE_PAUSED);
  begin_stream();
  set_state(GST_STATE_PLAYING);
  set_state(before);
  before_motion_changes_state = [this, state = after] { set_state(state); };
  EXPECT_EQ(push(), GST_FLOW_OK);
  EXPECT_EQ(before_motion_changes_state, nullptr);
  ASSERT_NE(motion(), nullptr);
  EXPECT_EQ(GST_STATE(motion()), after);
  EXPECT_EQ(GST_STATE(bin_), after);
}

INSTANTIATE_TEST_SUITE_P(All, FeelBinStates,
                         testing::Values(std::make_pair(GST_STATE_PLAYING, GST_STATE_PAUSED),
                                         std::make_pair(GST_STATE_PAUSED, GST_STATE_PLAYING)));

/// A seek's flush that arrives while spidarmotion, just put in, handles an event of this type.
class FeelBinFlushes : public FeelBin, public testing::WithParamInterface<GstEventType> {
 protected:
  /// Flushes when `pad` gets its next event of the type.
  void flush_during_event(GstPad* pad) {
    handle_event_ = GST_PAD_EVENTFUNC(pad);
    pad->eventdata = this;
    pad->eventfunc = [](GstPad* sink, GstObject* parent, GstEvent* event) {
      auto* self = static_cast<FeelBinFlushes*>(sink->eventdata);
      if (GST_EVENT_TYPE(event) == GetParam() && !std::exchange(self->flushed_, true))
        self->begin_flush();
      return self->handle_event_(sink, parent, event);
    };
  }
  bool flushed_ = false;

 private:
  GstPadEventFunction handle_event_ = nullptr;
};

TEST_P(FeelBinFlushes, DuringTheExchangeAreNoError) {
  set_state(GST_STATE_PAUSED);
  begin_stream();
  EXPECT_EQ(push(), GST_FLOW_OK);
  before_motion_changes_state = [this] {
    GstPad* pad = gst_element_get_static_pad(motion(), "sink");
    flush_during_event(pad);
    gst_object_unref(pad);
  };
  set_state(GST_STATE_PLAYING);
  EXPECT_EQ(push(), GST_FLOW_FLUSHING);
  EXPECT_TRUE(flushed_);
  end_flush();
  EXPECT_EQ(push(), GST_FLOW_OK);
  EXPECT_NE(motion(), nullptr);
}

INSTANTIATE_TEST_SUITE_P(All, FeelBinFlushes, testing::Values(GST_EVENT_CAPS, GST_EVENT_SEGMENT));

using Quarter = std::pair<int, int>;  ///< 0: left or upper, 1: right or lower

/// The quarter of a picture that is bright.
Quarter bright_quarter(GstBuffer* buffer, const GstVideoInfo& info) {
  GstVideoFrame frame;
  EXPECT_TRUE(gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ));
  Quarter brightest;
  int largest = -1;
  for (const Quarter& quarter : {Quarter(0, 0), Quarter(0, 1), Quarter(1, 0), Quarter(1, 1)}) {
    const int x = info.width * (1 + 2 * quarter.first) / 4;
    const int y = info.height * (1 + 2 * quarter.second) / 4;
    const auto* const luma = static_cast<const guint8*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0));
    const int level = luma[y * GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0) + x];
    if (level > largest) brightest = quarter;
    largest = std::max(largest, level);
  }
  gst_video_frame_unmap(&frame);
  return brightest;
}

/// Frames whose upper left quarter is bright, in a player that shows pictures as they are stored.
class FeelBinTurns : public FeelBin, public testing::WithParamInterface<const char*> {
 protected:
  FeelBinTurns() : FeelBin(true) {}

  void push_marked() {
    const auto grey = [this](int x, int y) {
      return 2 * x < info_.width && 2 * y < info_.height ? 200 : 50;
    };
    EXPECT_EQ(push(make_picture(info_, grey)), GST_FLOW_OK);
  }
  /// Expects that the last frame was shown as this tag says, and that it needs no other turn.
  void expect_shown(const char* tag) {
    GstTagList* const tags = gst_tag_list_new(GST_TAG_IMAGE_ORIENTATION, tag, nullptr);
    StreamOrientation stored;
    stored.update(tags);
    gst_tag_list_unref(tags);
    GstCaps* const caps = gst_pad_get_current_caps(end_);
    GstVideoInfo shown;
    ASSERT_TRUE(gst_video_info_from_caps(&shown, caps));
    gst_caps_unref(caps);
    EXPECT_EQ(shown.width, stored.turn().is_sideways() ? info_.height : info_.width);
    const Eigen::Vector2d bright = stored.turn().displayed_position({0.25, 0.25});
    EXPECT_EQ(bright_quarter(shown_, shown), Quarter(bright.x() > 0.5, bright.y() > 0.5));
    GstEvent* const event = gst_pad_get_sticky_event(end_, GST_EVENT_TAG, 0);
    if (!event) return;
    GstTagList* left = nullptr;
    gst_event_parse_tag(event, &left);
    StreamOrientation still;
    still.update(left);
    EXPECT_TRUE(still.turn().is_none());
    gst_event_unref(event);
  }
};

/// Also the first one, which is shown while the player is paused.
TEST_P(FeelBinTurns, PicturesUprightForWhoeverShowsAndFeelsThem) {
  set_state(GST_STATE_PAUSED);
  begin_stream();
  push_orientation(GetParam());
  push_marked();
  expect_shown(GetParam());
  set_state(GST_STATE_PLAYING);
  push_marked();
  ASSERT_NE(motion(), nullptr);
  expect_shown(GetParam());
  // The next film of a list, which says nothing.
  begin_stream();
  push_marked();
  expect_shown("rotate-0");
  begin_stream();
  push_orientation("flip-rotate-90");
  push_marked();
  expect_shown("flip-rotate-90");
}

INSTANTIATE_TEST_SUITE_P(All, FeelBinTurns,
                         testing::Values("rotate-0", "rotate-90", "rotate-180", "rotate-270",
                                         "flip-rotate-0", "flip-rotate-90", "flip-rotate-180",
                                         "flip-rotate-270"));

TEST_F(FeelBin, LeavesPicturesToAPlayerThatMayTurnThem) {
  set_state(GST_STATE_PAUSED);
  begin_stream();
  push_orientation("rotate-90");
  set_state(GST_STATE_PLAYING);
  testing::internal::CaptureStderr();
  EXPECT_EQ(push(), GST_FLOW_OK);
  EXPECT_EQ(push(), GST_FLOW_OK);
  const std::string said = testing::internal::GetCapturedStderr();
  const size_t first = said.find("stored on its side");
  EXPECT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.find("stored on its side", first + 1), std::string::npos) << said;
  GstCaps* const caps = gst_pad_get_current_caps(end_);
  gint width = 0;
  gst_structure_get_int(gst_caps_get_structure(caps, 0), "width", &width);
  EXPECT_EQ(width, info_.width);
  gst_caps_unref(caps);
}

}  // namespace
}  // namespace spidar::test::feel_bin_test
