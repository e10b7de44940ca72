// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Without the overlay frames are only read: the output buffers are the input buffers, and queries
// for downstream are answered by downstream.
#include "tests/element/watched_memory.h"
#include "tests/support/element_harness.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test::passthrough_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

/// The picture of make_frame(), in memory that counts accesses.
GstBuffer* make_watched_frame(const GstVideoInfo& info, double dx, MemoryUse& use) {
  GstBuffer* picture = make_frame(info, dx, 0);
  GstBuffer* frame = gst_buffer_new();
  gst_buffer_append_memory(frame, new_watched_memory(gst_buffer_get_size(picture), use));
  GstMapInfo map;
  gst_buffer_map(frame, &map, GST_MAP_WRITE);
  gst_buffer_extract(picture, 0, map.data, map.size);
  gst_buffer_unmap(frame, &map);
  gst_buffer_copy_into(frame, picture, GST_BUFFER_COPY_META, 0, static_cast<gsize>(-1));
  gst_buffer_unref(picture);
  use = {};
  return frame;
}

int count_metas(GstBuffer* buffer) {
  gpointer state = nullptr;
  int count = 0;
  while (gst_buffer_iterate_meta(buffer, &state)) ++count;
  return count;
}

class Passthrough : public testing::TestWithParam<const char*> {
 protected:
  void open(const char* format) {
    const std::string trace = " trace=" + (folder_.path / "trace.csv").string();
    h = std::make_unique<ElementHarness>(GetParam() + trace);
    h->set_caps(make_caps(format, 320, 240));
  }

  /// Pushes the next frame and compares the output with it.
  void expect_same(bool held, guint flags = 0) {
    const int n = frames_++;
    GstBuffer* frame = make_watched_frame(h->info(), 2.0 * n, use);
    GstMemory* memory = gst_buffer_peek_memory(frame, 0);
    const int metas = count_metas(frame);
    if (held) gst_buffer_ref(frame);
    const auto pts = static_cast<GstClockTime>(n) * kFrame;
    ASSERT_EQ(h->push(frame, pts, flags), GST_FLOW_OK);
    GstBuffer* out = gst_harness_pull(h->harness());
    EXPECT_EQ(out, frame);
    EXPECT_EQ(gst_buffer_n_memory(out), 1u);
    EXPECT_EQ(gst_buffer_peek_memory(out, 0), memory);
    EXPECT_EQ(GST_MINI_OBJECT_REFCOUNT(memory), 1);
    EXPECT_EQ(GST_MINI_OBJECT_REFCOUNT(out), held ? 2 : 1) << "the element holds it";
    EXPECT_EQ(gst_buffer_is_writable(out), !held);
    EXPECT_EQ(count_metas(out), metas);
    EXPECT_EQ(GST_BUFFER_PTS(out), pts);
    EXPECT_EQ(GST_BUFFER_FLAGS(out) & flags, flags);
    EXPECT_EQ(use.writes, 0);
    EXPECT_EQ(use.copies, 0);
    if (held) gst_buffer_unref(frame);
    gst_buffer_unref(out);
  }

  std::unique_ptr<ElementHarness> h;
  MemoryUse use;

 private:
  TemporaryFolder folder_;
  int frames_ = 0;
};

TEST_P(Passthrough, NeitherCopiesNorWritesNorKeepsAFrame) {
  // Luma that is read in place, and luma that must be converted.
  for (const char* format : {"I420", "BGR"}) {
    SCOPED_TRACE(format);
    open(format);
    for (const bool held : {false, true, false, true}) {
      expect_same(held);
      EXPECT_GT(use.reads, 0);
    }
    EXPECT_TRUE(h->errors().empty());
  }
}

TEST_P(Passthrough, AGapIsNotEvenMapped) {
  open("I420");
  expect_same(false);
  expect_same(false);
  for (const bool held : {false, true}) {
    expect_same(held, GST_BUFFER_FLAG_GAP);
    EXPECT_EQ(use.reads, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, Passthrough,
                         testing::Values("device=sim", "device=none",
                                         "device=none post-messages=true",
                                         "device=none motion=mean", "device=none mute=true",
                                         "device=none motion=objects",
                                         "device=none overlay=points overlay=none"));

TEST(Gap, RepeatsThePreviousPictureWithoutAnalysis) {
  for (const char* properties : {"device=none", "device=none overlay=points"}) {
    SCOPED_TRACE(properties);
    ElementHarness h(properties);
    h.set_caps(make_caps("GRAY8", 320, 240));
    for (int n = 0; n < 5; ++n) {
      GstBuffer* frame = make_frame(h.info(), 2.0 * n, 0);
      gst_buffer_ref(frame);  // held by somebody else: drawing the overlay takes a copy
      h.push(frame, static_cast<GstClockTime>(n) * kFrame, n == 2 ? GST_BUFFER_FLAG_GAP : 0);
      GstBuffer* out = gst_harness_pull(h.harness());
      EXPECT_EQ(GST_BUFFER_FLAG_IS_SET(out, GST_BUFFER_FLAG_GAP), n == 2);
      gst_buffer_unref(out);
      gst_buffer_unref(frame);
    }
    const auto& motions = h.motions();
    ASSERT_EQ(motions.size(), 4u);
    EXPECT_GT(motions[1].tracked, 20u);
    EXPECT_EQ(motions[2].timestamp, 3 * kFrame);
    // 4 px in two frames, as good as a tenth of a pixel (see test_frames.cpp).
    for (size_t n = 1; n < 4; ++n) {
      EXPECT_GT(motions[n].tracked, 20u);
      EXPECT_NEAR(motions[n].velocity_x, 2 * 25, 0.1 * 25);
    }
    EXPECT_TRUE(h.warnings().empty());
  }
}

TEST(Gap, FramesAroundALongGapAreNotCompared) {
  ElementHarness h;
  h.set_caps(make_caps("GRAY8", 320, 240));
  for (int n = 0; n < 9; ++n) {
    const bool gap = n >= 2 && n < 7;  // the last of them 200 ms after the picture
    h.push(make_frame(h.info(), 2.0 * n, 0), static_cast<GstClockTime>(n) * kFrame,
           gap ? GST_BUFFER_FLAG_GAP : 0);
  }
  const auto& motions = h.motions();
  ASSERT_EQ(motions.size(), 4u);
  EXPECT_EQ(motions[2].tracked, 0u);
  EXPECT_EQ(motions[2].velocity_x, 0);
  EXPECT_NEAR(motions[3].velocity_x, 2 * 25, 0.1 * 25);
}

/// An element between a source that asks for memory and a sink that offers some.
class Allocation : public testing::Test {
 protected:
  Allocation() {
    init_gstreamer();
    pool_ = gst_buffer_pool_new();
    caps_ = make_caps("I420", 320, 240);
  }
  ~Allocation() override {
    gst_caps_unref(caps_);
    gst_object_unref(pool_);
  }

  /// The answer that the source gets, as text; without an offer the sink refuses to answer.
  std::string ask(GstElement* element, bool offers = true, bool need_pool = true) {
    GstHarness* h = gst_harness_new_with_element(element, "sink", "src");
    gst_harness_set_src_caps(h, gst_caps_ref(caps_));
    offers_ = offers;
    gst_pad_add_probe(h->sinkpad, GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM, answer, this, nullptr);
    GstQuery* query = gst_query_new_allocation(caps_, need_pool);
    const bool answered = gst_pad_peer_query(h->srcpad, query) != FALSE;
    const std::string words = answered ? describe(query) : "no answer";
    gst_query_unref(query);
    gst_harness_teardown(h);
    return words;
  }
  std::string ask(const char* launch, bool offers = true, bool need_pool = true) {
    GstElement* element = gst_parse_launch(launch, nullptr);
    gst_object_ref_sink(element);
    const std::string words = ask(element, offers, need_pool);
    gst_object_unref(element);
    return words;
  }

 private:
  static GstPadProbeReturn answer(GstPad*, GstPadProbeInfo* info, gpointer data) {
    GstQuery* query = GST_PAD_PROBE_INFO_QUERY(info);
    auto* self = static_cast<Allocation*>(data);
    if (GST_QUERY_TYPE(query) != GST_QUERY_ALLOCATION) return GST_PAD_PROBE_OK;
    if (!self->offers_) return GST_PAD_PROBE_DROP;
    GstCaps* caps;
    gboolean need_pool;
    gst_query_parse_allocation(query, &caps, &need_pool);
    gst_query_add_allocation_pool(query, need_pool ? self->pool_ : nullptr, 4711, 3, 7);
    GstStructure* alignment =
        gst_structure_new("video-meta", "padding-top", G_TYPE_UINT, 16, nullptr);
    gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, alignment);
    gst_structure_free(alignment);
    gst_query_add_allocation_meta(query, GST_VIDEO_CROP_META_API_TYPE, nullptr);
    GstAllocationParams params;
    gst_allocation_params_init(&params);
    params.align = 63;
    gst_query_add_allocation_param(query, nullptr, &params);
    return GST_PAD_PROBE_HANDLED;
  }

  std::string describe(GstQuery* query) const {
    std::string words;
    for (guint i = 0; i < gst_query_get_n_allocation_pools(query); ++i) {
      GstBufferPool* pool = nullptr;
      guint size, least, most;
      gst_query_parse_nth_allocation_pool(query, i, &pool, &size, &least, &most);
      words += pool == pool_ ? "the sink's pool" : pool ? "another pool" : "no pool";
      for (const guint number : {size, least, most}) words += " " + std::to_string(number);
      words += "\n";
      gst_clear_object(&pool);
    }
    for (guint i = 0; i < gst_query_get_n_allocation_metas(query); ++i) {
      const GstStructure* params = nullptr;
      words += g_type_name(gst_query_parse_nth_allocation_meta(query, i, &params));
      gchar* text = params ? gst_structure_to_string(params) : g_strdup("");
      words += std::string(" ") + text + "\n";
      g_free(text);
    }
    for (guint i = 0; i < gst_query_get_n_allocation_params(query); ++i) {
      GstAllocationParams params;
      gst_query_parse_nth_allocation_param(query, i, nullptr, &params);
      words += "aligned to " + std::to_string(params.align + 1) + "\n";
    }
    return words;
  }

  GstBufferPool* pool_;
  GstCaps* caps_;
  bool offers_ = true;
};

TEST_F(Allocation, IsAnsweredByTheSinkAsWithIdentity) {
  const std::string offered = ask("identity");
  EXPECT_EQ(offered,
            "the sink's pool 4711 3 7\n"
            "GstVideoMetaAPI video-meta, padding-top=(uint)16;\n"
            "GstVideoCropMetaAPI \n"
            "aligned to 64\n");
  for (const char* element : {"spidarmotion device=none", "spidarmotion device=sim",
                              "spidarmotion device=none attach-meta=true",
                              "spidarmotion device=none overlay=points overlay=none"}) {
    SCOPED_TRACE(element);
    EXPECT_EQ(ask(element), offered);
    EXPECT_EQ(ask(element, true, false), ask("identity", true, false));
    EXPECT_EQ(ask(element, false), ask("identity", false));
  }
}

}  // namespace
}  // namespace spidar::test::passthrough_test
