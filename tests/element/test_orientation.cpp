// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames that are turned or mirrored before they are shown: the tag image-orientation.
#include "plugin/frame/stream_orientation.h"
#include "tests/element/simulated_element.h"
#include "tests/support/test.h"

namespace spidar::test::orientation_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

GstTagList* orientation_tags(const char* orientation, GstTagScope scope) {
  GstTagList* tags = gst_tag_list_new(GST_TAG_IMAGE_ORIENTATION, orientation, nullptr);
  gst_tag_list_set_scope(tags, scope);
  return tags;
}

/// Where right and down of the frame lead in the picture that is shown, by the description of
/// GST_TAG_IMAGE_ORIENTATION: "flip-rotate-90" is first mirrored left to right, then turned by 90°
/// clockwise. x right, y down.
struct Turn {
  const char* tag;
  Eigen::Vector2d right, down;
};
const Turn kTurns[] = {
    {"rotate-0", {1, 0}, {0, 1}},         {"rotate-90", {0, 1}, {-1, 0}},
    {"rotate-180", {-1, 0}, {0, -1}},     {"rotate-270", {0, -1}, {1, 0}},
    {"flip-rotate-0", {-1, 0}, {0, 1}},   {"flip-rotate-90", {0, -1}, {-1, 0}},
    {"flip-rotate-180", {1, 0}, {0, -1}}, {"flip-rotate-270", {0, 1}, {1, 0}},
};

/// After two frames of this size, between which everything moves by this; right and a little up.
Wrench felt_with(const std::vector<GstTagList*>& tags, int width = 240, int height = 240,
                 const Eigen::Vector2d& moved_px = {2, -1}) {
  ElementHarness h;
  h.set_caps(make_caps("GRAY8", width, height));
  for (GstTagList* given : tags) gst_harness_push_event(h.harness(), gst_event_new_tag(given));
  for (int n = 0; n < 2; ++n)
    h.push_moved(n * moved_px.x(), n * moved_px.y(), static_cast<GstClockTime>(n) * kFrame);
  EXPECT_EQ(h.motions().size(), 2u);
  EXPECT_NEAR(h.motions().back().velocity_x, 25 * moved_px.x(), 2.5)
      << "of the frame, not of what is shown";
  return h.motions().back().wrench;
}

TEST(Orientation, ForceIsTurnedLikeThePicture) {
  const Wrench plain = felt_with({});
  ASSERT_GT(plain.force_N.head<2>().norm(), 0.1);
  for (const Turn& turn : kTurns) {
    for (const GstTagScope scope : {GST_TAG_SCOPE_STREAM, GST_TAG_SCOPE_GLOBAL}) {
      SCOPED_TRACE(turn.tag);
      const Wrench felt = felt_with({orientation_tags(turn.tag, scope)});
      const Eigen::Vector2d shown = plain.force_N.x() * turn.right - plain.force_N.y() * turn.down;
      // The same numbers, exchanged and negated.
      EXPECT_EQ(felt.force_N, Eigen::Vector3d(shown.x(), -shown.y(), plain.force_N.z()));
    }
  }
}

TEST(Orientation, AnUprightFilmIsAsStrongOnItsSide) {
  const double upright_N = felt_with({}, 240, 320, {1, 2}).force_N.norm();
  GstTagList* const tag = orientation_tags("rotate-90", GST_TAG_SCOPE_STREAM);
  const double on_its_side_N = felt_with({tag}, 320, 240, {2, -1}).force_N.norm();
  // The force rises at most in proportion to the speed, and velocities are right to 2.5 of 56 px/s.
  EXPECT_NEAR(on_its_side_N, upright_N, 2 * 2.5 / 56 * upright_N);
}

TEST(Orientation, TheTagOfTheStreamCountsBeforeThatOfTheFilm) {
  const Wrench plain = felt_with({});
  for (const bool stream_first : {true, false}) {
    GstTagList* const of_stream = orientation_tags("rotate-180", GST_TAG_SCOPE_STREAM);
    GstTagList* const of_film = orientation_tags("rotate-90", GST_TAG_SCOPE_GLOBAL);
    const Wrench felt =
        stream_first ? felt_with({of_stream, of_film}) : felt_with({of_film, of_stream});
    EXPECT_EQ(felt.force_N.x(), -plain.force_N.x());
  }
  StreamOrientation orientation;
  GstTagList* tags = orientation_tags("rotate-90", GST_TAG_SCOPE_STREAM);
  orientation.update(tags);
  gst_tag_list_unref(tags);
  EXPECT_TRUE(orientation.turn().is_sideways());
  orientation.begin_stream();
  EXPECT_TRUE(orientation.turn().is_none());
}

TEST(Orientation, AMirrorReversesTheTorqueAboutTheViewAxis) {
  const Wrench wrench{{1, 2, 3}, {0.1, 0.2, 0.3}};
  EXPECT_EQ(Orientation(1).to_displayed(wrench).torque_Nm, Eigen::Vector3d(0.2, -0.1, 0.3));
  EXPECT_EQ(Orientation(0, true).to_displayed(wrench).torque_Nm, Eigen::Vector3d(0.1, -0.2, -0.3));
  EXPECT_EQ(Orientation(0, true).to_displayed(wrench).force_N, Eigen::Vector3d(-1, 2, 3));
}

TEST(Orientation, PlacesAreTurnedThereAndBack) {
  // Of a picture on its right side, the lower left corner is shown in the upper left one.
  EXPECT_EQ(Orientation(1).stored_position({0, 0}), Eigen::Vector2d(0, 1));
  for (int i = 0; i < 8; ++i) {
    const Orientation turn(i % 4, i >= 4);
    const Eigen::Vector2d position(0.25, 0.875);
    EXPECT_EQ(turn.displayed_position(turn.stored_position(position)), position)
        << "quarters are exact";
  }
}

class OrientedRelief : public SimulatedElement {
 protected:
  /// The force on a grip that is pressed into the middle of a frame that becomes brighter to the
  /// right and downwards, and is shown in this orientation.
  Eigen::Vector3d contact_N_with(const char* orientation, int width, int height) {
    open("device=sim touch=luma touch-friction=0", width, height);
    play();
    gst_harness_push_event(h->harness(),
                           gst_event_new_tag(orientation_tags(orientation, GST_TAG_SCOPE_STREAM)));
    const auto grey = [&](int x, int y) { return 16 + 100 * x / width + 100 * y / height; };
    EXPECT_EQ(h->push(make_picture(h->info(), grey), 0), GST_FLOW_OK);
    h->state().feed.output.lead_hand(Eigen::Vector3d(0, 0, -0.01));
    tick(1000);
    return h->state().feed.output.snapshot()->last.contact.force_N;
  }
};

TEST_F(OrientedRelief, IsTurnedLikeThePicture) {
  for (const Turn& turn : kTurns) {
    // Where it is shown brighter, and therefore nearer.
    const Eigen::Vector2d brighter = turn.right + turn.down;
    // In place, and thinned in one direction or in both.
    for (const auto& [width, height] :
         {std::pair(320, 240), std::pair(1280, 160), std::pair(1280, 720)}) {
      SCOPED_TRACE(std::string(turn.tag) + " " + std::to_string(width));
      const Eigen::Vector3d contact_N = contact_N_with(turn.tag, width, height);
      EXPECT_GT(contact_N.z(), 0.5);
      // The surface pushes away from what is near, by a slope of 100 / 219 · 8 mm in some 60 mm.
      EXPECT_GT(contact_N.x() * -brighter.x(), 0.03 * contact_N.z());
      EXPECT_GT(contact_N.y() * brighter.y(), 0.03 * contact_N.z());
    }
  }
}

}  // namespace
}  // namespace spidar::test::orientation_test
