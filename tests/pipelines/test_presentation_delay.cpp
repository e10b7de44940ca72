// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Delays of the picture after the element delay the force equally. On a test clock.
#include <gst/base/gstbasesink.h>

#include "tests/pipelines/shown_motion.h"
#include "tests/support/test.h"

namespace spidar::test::presentation_delay_test {
namespace {

constexpr GstClockTime kDelay = 100 * GST_MSECOND;

/// A frame that is shown `delay` after its running time is felt at that time.
void expect_in_time(SteppedPipeline& pipeline, int frames, GstClockTime delay, guint waiters = 1) {
  int felt = 0;
  for (int n = 0; n < frames;) {
    const TickRecord tick = pipeline.step(waiters);
    const GstClockTime running_time =
        pipeline.now() - gst_element_get_base_time(pipeline.pipeline()) - delay;
    if (running_time > 1000 * GST_SECOND || running_time % kFrame != 0)
      continue;  // a source's step
    SCOPED_TRACE(running_time);
    ++n;
    EXPECT_EQ(tick.running_ns + pipeline.early_ns(), static_cast<int64_t>(running_time));
    expect_wrench_of(pipeline, tick, running_time);
    if (tick.wanted.force_N.norm() > 0) ++felt;
  }
  EXPECT_GT(felt, frames / 2);
}

/// The one pad in that direction.
GstPad* pad_of(SteppedPipeline& pipeline, const char* element_name, GstPadDirection direction) {
  GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline.pipeline()), element_name);
  GList* pads = direction == GST_PAD_SRC ? element->srcpads : element->sinkpads;
  GstPad* pad = GST_PAD(gst_object_ref(pads->data));
  gst_object_unref(element);
  return pad;
}

TEST(PresentationDelay, OffsetsOfThePadsOnTheWay) {
  struct Position {
    const char* element;
    GstPadDirection direction;
  };
  for (const Position position : {Position{"motion", GST_PAD_SRC},
                                  {"queue", GST_PAD_SINK},
                                  {"queue", GST_PAD_SRC},
                                  {"box", GST_PAD_SINK},
                                  {"sink", GST_PAD_SINK}}) {
    SCOPED_TRACE(std::string(position.element) +
                 (position.direction == GST_PAD_SRC ? " src" : " sink"));
    SteppedPipeline pipeline(kBall + kMotion +
                             "! queue name=queue bin.( name=box fakesink name=sink sync=true ) "
                             "queue. ! sink.");
    GstPad* pad = pad_of(pipeline, position.element, position.direction);
    gst_pad_set_offset(pad, kDelay);
    gst_object_unref(pad);
    pipeline.set_state(GST_STATE_PLAYING);
    expect_in_time(pipeline, 10, kDelay);
  }
}

TEST(PresentationDelay, AnElementThatWaitsForTheClockBeforeTheSink) {
  for (const char* waiting : {"clocksync", "identity sync=true"}) {
    for (const char* sink_waits : {"true", "false"}) {
      SCOPED_TRACE(std::string(waiting) + ", sink sync=" + sink_waits);
      SteppedPipeline pipeline(kBall + kMotion + "! queue ! " + waiting +
                               " ts-offset=100000000 ! fakesink name=sink sync=" + sink_waits);
      pipeline.play_live();
      expect_in_time(pipeline, 10, kDelay);
    }
  }
}

/// Puts the element between `position` and `queue` of a pipeline that plays.
GstPadProbeReturn insert(GstPad* source, GstPadProbeInfo*, gpointer user) {
  auto& pipeline = *static_cast<SteppedPipeline*>(user);
  GstPad* next = gst_pad_get_peer(source);
  EXPECT_TRUE(gst_pad_unlink(source, next));
  GstPad* in = pad_of(pipeline, "motion", GST_PAD_SINK);
  GstPad* out = pad_of(pipeline, "motion", GST_PAD_SRC);
  EXPECT_EQ(gst_pad_link(out, next), GST_PAD_LINK_OK);
  EXPECT_EQ(gst_pad_link(source, in), GST_PAD_LINK_OK);
  for (GstPad* pad : {next, in, out}) gst_object_unref(pad);
  return GST_PAD_PROBE_REMOVE;
}

TEST(PresentationDelay, PutIntoALivePipelineThatPlays) {
  for (const bool plays_before_it_is_linked : {false, true}) {
    SCOPED_TRACE(plays_before_it_is_linked);
    SteppedPipeline pipeline(
        "videotestsrc is-live=true pattern=ball ! "
        "video/x-raw,format=GRAY8,width=320,height=240,framerate=25/1 ! identity name=position ! "
        "queue ! fakesink name=sink sync=true processing-deadline=100000000 " +
        kMotion.substr(kMotion.find("spidarmotion")));
    if (!plays_before_it_is_linked) {
      gst_element_set_state(pipeline.element(), GST_STATE_READY);
      gst_element_set_locked_state(pipeline.element(), TRUE);
    }
    pipeline.play_live();
    pipeline.step();
    for (int n = 0; n < 10; ++n) pipeline.step(2);
    GstPad* pad = pad_of(pipeline, "position", GST_PAD_SRC);
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_IDLE, insert, &pipeline, nullptr);
    gst_object_unref(pad);
    if (!plays_before_it_is_linked) {
      gst_element_set_locked_state(pipeline.element(), FALSE);
      gst_element_sync_state_with_parent(pipeline.element());
    }
    // What went past it is shown first: the source asks the queue for memory, which waits for that.
    for (int n = 0; n < 10; ++n) pipeline.step();
    for (int n = 0; n < 10; ++n) pipeline.step(2);
    const GstClockTime latency = gst_base_sink_get_latency(GST_BASE_SINK(pipeline.sink()));
    EXPECT_GE(latency, kDelay);
    expect_in_time(pipeline, 10, latency, 2);
  }
}

}  // namespace
}  // namespace spidar::test::presentation_delay_test
