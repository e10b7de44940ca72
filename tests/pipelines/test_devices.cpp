// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Several devices in one pipeline, each with a force of its own. On a test clock.
#include "plugin/filter/spidar_motion.h"
#include "tests/pipelines/shown_motion.h"
#include "tests/support/test.h"

namespace spidar::test::devices_test {
namespace {

const std::string kPaper =
    "motion=mean filter-min-cutoff=0 controller=nonlinear max-force=3 alpha=0.0005 ";

/// Another element of a SteppedPipeline, ticked when that one is.
class OtherElement {
 public:
  OtherElement(SteppedPipeline& pipeline, const char* name) : pipeline_(pipeline) {
    element_ = gst_bin_get_by_name(GST_BIN(pipeline.pipeline()), name);
    state().feed.output.set_manual([&pipeline] { return static_cast<int64_t>(pipeline.now()); });
  }
  ~OtherElement() { gst_object_unref(element_); }
  OtherElement(const OtherElement&) = delete;
  OtherElement& operator=(const OtherElement&) = delete;

  TickRecord tick() {
    state().feed.output.follower().refresh();
    return watch_.tick(state().feed.output.session()->loop(),
                       static_cast<int64_t>(pipeline_.now()));
  }
  const std::string& device() { return state().feed.output.session()->grip().name(); }

 private:
  filter::MotionState& state() { return gst_spidar_motion_state(GST_SPIDAR_MOTION(element_)); }

  SteppedPipeline& pipeline_;
  GstElement* element_;
  TickWatch watch_;
};

TEST(Devices, TwoInOnePipelineFeelWhatEachIsShown) {
  // The second sees the ball in a mirror.
  SteppedPipeline pipeline(
      "videotestsrc pattern=ball ! video/x-raw,format=GRAY8,width=320,height=240,framerate=25/1 ! "
      "spidarmotion name=motion device=sim:sh4 profile=spidar-g6x3-v2-r " +
      kPaper +
      "! videoflip video-direction=horiz ! spidarmotion name=other device=sim:uart "
      "post-messages=false " +
      kPaper + kSink);
  OtherElement other(pipeline, "other");
  pipeline.set_state(GST_STATE_PLAYING);
  EXPECT_EQ(other.device(), "sim:uart");
  for (int n = 0; n < 20; ++n) {
    SCOPED_TRACE(n);
    TickRecord mirrored;
    const TickRecord tick = pipeline.step(1, [&] { mirrored = other.tick(); });
    expect_wrench_of_frame(pipeline, tick);
    EXPECT_EQ(mirrored.running_ns, tick.running_ns);
    EXPECT_EQ(mirrored.found, Found::kExact);
    const Eigen::Vector3d felt_px_s = velocity_px_s(tick.wanted.force_N);
    const Eigen::Vector3d expected_px_s(-felt_px_s.x(), felt_px_s.y(), felt_px_s.z());
    EXPECT_LT((velocity_px_s(mirrored.wanted.force_N) - expected_px_s).norm(), kTolerance_px_s);
    EXPECT_EQ(felt_px_s.norm() > kMoves_px_s, n > 0);
  }
}

}  // namespace
}  // namespace spidar::test::devices_test
