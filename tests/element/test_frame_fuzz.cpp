// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Random frames of every format, size, stride, crop and field order, in any number of memories: the
// measured motion is, bit for bit, that of the same picture as plain GRAY8 (with more than 8 bits:
// of the 8 highest), and no byte outside the picture is touched (tests/support/guarded_frame.h).
//
// SPIDAR_SEED is the seed (default 1), SPIDAR_FILMS the number of films of three frames (default
// 60).
#include "core/picture/luma.h"
#include "plugin/frame/frame_luma.h"
#include "tests/support/element_harness.h"
#include "tests/support/guarded_frame.h"
#include "tests/support/test.h"
#include "tests/support/video_formats.h"
#include "tests/support/video_frames.h"

namespace spidar::test::frame_fuzz_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

uint64_t number_from(const char* variable, uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

GreyPicture picture_of(int width, int height, double dx, double dy) {
  GreyPicture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      picture.level.push_back(static_cast<uint8_t>(texture(x - dx, y - dy)));
    }
  }
  return picture;
}

GreyPicture part_of(const GreyPicture& whole, const PicturePart& part) {
  GreyPicture picture{part.width, part.height, {}};
  for (int y = 0; y < part.height; ++y) {
    for (int x = 0; x < part.width; ++x) {
      picture.level.push_back(whole.at(part.x + x, part.y + y));
    }
  }
  return picture;
}

/// Three frames of one format, which one of two harnesses gets as plain grey.
class Film {
 public:
  Film(RandomSource& random) : random_(random) {
    format_ = random.one_of(video_formats());
    // Now and then larger than a cache, else quick.
    const bool large = random.chance(0.02);
    whole_.width = static_cast<int>(large ? random.between(900, 1300) : random.between(16, 300));
    whole_.height = static_cast<int>(large ? random.between(500, 800) : random.between(16, 300));
    shown_ = whole_;
    if (random.chance(0.3)) crop();
    interlaced_ = random.chance(0.2);
    top_first_ = random.chance(0.5);
    overlay_ = random.chance(0.2);
  }

  std::string description() const {
    return format_ + " " + std::to_string(whole_.width) + "x" + std::to_string(whole_.height) +
           ", shown " + std::to_string(shown_.width) + "x" + std::to_string(shown_.height) + "+" +
           std::to_string(shown_.x) + "+" + std::to_string(shown_.y) +
           (interlaced_ ? top_first_ ? ", top field first" : ", bottom field first" : "");
  }

  void push(ElementHarness& fuzzed, ElementHarness& plain, GstClockTime& pts) {
    g_object_set(fuzzed.element(), "overlay", overlay_, nullptr);
    fuzzed.set_caps(caps(format_, whole_, top_first_));
    // A crop that begins on an odd line begins with the other field.
    const bool top_is_shown_first = top_first_ == (shown_.y % 2 == 0);
    plain.set_caps(caps("GRAY8", shown_, top_is_shown_first));
    for (int n = 0; n < 3; ++n, pts += kFrame) {
      const GreyPicture picture = picture_of(whole_.width, whole_.height, 1.5 * n, -n);
      const FrameLayout layout = random_layout(fuzzed.info(), random_);
      GstBuffer* frame = make_guarded_frame(fuzzed.info(), picture, layout, random_);
      if (shown_.width != whole_.width || shown_.height != whole_.height) {
        GstVideoCropMeta* meta = gst_buffer_add_video_crop_meta(frame);
        meta->x = static_cast<guint>(shown_.x);
        meta->y = static_cast<guint>(shown_.y);
        meta->width = static_cast<guint>(shown_.width);
        meta->height = static_cast<guint>(shown_.height);
      }
      const GreyPicture seen = part_of(picture, shown_);
      if (!interlaced_) expect_luma(fuzzed.info(), frame, seen);
      EXPECT_EQ(fuzzed.push(frame, pts, flags(top_first_)), GST_FLOW_OK)
          << (fuzzed.errors().empty() ? "" : fuzzed.errors().back());
      EXPECT_EQ(plain.push(tight(plain.info(), seen), pts, flags(top_is_shown_first)), GST_FLOW_OK);
    }
  }

 private:
  void crop() {
    shown_.width = static_cast<int>(random_.between(16, whole_.width));
    shown_.height = static_cast<int>(random_.between(16, whole_.height));
    shown_.x = static_cast<int>(random_.between(0, whole_.width - shown_.width));
    shown_.y = static_cast<int>(random_.between(0, whole_.height - shown_.height));
  }

  GstCaps* caps(const std::string& format, const PicturePart& size, bool top_first) const {
    GstCaps* caps = make_caps(format.c_str(), size.width, size.height);
    if (interlaced_) {
      gst_caps_set_simple(caps, "interlace-mode", G_TYPE_STRING, "interleaved", "field-order",
                          G_TYPE_STRING, top_first ? "top-field-first" : "bottom-field-first",
                          nullptr);
    }
    return caps;
  }

  guint flags(bool top_first) const {
    if (!interlaced_) return 0;
    return GST_VIDEO_BUFFER_FLAG_INTERLACED | (top_first ? GST_VIDEO_BUFFER_FLAG_TFF : 0);
  }

  /// GStreamer's own layout: lines begin at multiples of four bytes.
  static GstBuffer* tight(const GstVideoInfo& info, const GreyPicture& picture) {
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
    for (int y = 0; y < picture.height; ++y) {
      gst_buffer_fill(buffer, static_cast<gsize>(GST_VIDEO_INFO_PLANE_STRIDE(&info, 0) * y),
                      picture.level.data() + y * picture.width, static_cast<gsize>(picture.width));
    }
    return buffer;
  }

  void expect_luma(const GstVideoInfo& info, GstBuffer* buffer, const GreyPicture& seen) {
    GstVideoFrame frame;
    ASSERT_TRUE(gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ));
    EXPECT_TRUE(holds_picture(frame));
    const ImageView luma = luma_.view(frame);
    ASSERT_EQ(luma.width, seen.width);
    ASSERT_EQ(luma.height, seen.height);
    std::vector<uint8_t> line(static_cast<size_t>(seen.width));
    for (int y = 0; y < seen.height; ++y) {
      copy_row(luma, 0, y, seen.width, line.data());
      ASSERT_EQ(std::memcmp(line.data(),
                            &seen.level[static_cast<size_t>(y) * static_cast<size_t>(seen.width)],
                            static_cast<size_t>(seen.width)),
                0)
          << "line " << y;
    }
    gst_video_frame_unmap(&frame);
  }

  RandomSource& random_;
  std::string format_;
  PicturePart whole_, shown_;
  bool interlaced_ = false, top_first_ = false, overlay_ = false;
  FrameLuma luma_;
};

TEST(FrameFuzz, TheSamePictureIsMeasuredTheSameHoweverItIsStored) {
  const uint64_t seed = number_from("SPIDAR_SEED", 1);
  const uint64_t films = number_from("SPIDAR_FILMS", 60);
  RandomSource random(seed);
  ElementHarness fuzzed, plain;
  GstClockTime pts = 0;
  uint64_t tracked = 0;
  for (uint64_t n = 0; n < films && !testing::Test::HasFailure(); ++n) {
    Film film(random);
    SCOPED_TRACE("SPIDAR_SEED=" + std::to_string(seed) + ", film " + std::to_string(n) + ": " +
                 film.description());
    const size_t before = fuzzed.motions().size();
    film.push(fuzzed, plain, pts);
    ASSERT_EQ(fuzzed.motions().size(), before + 3);
    ASSERT_EQ(plain.motions().size(), before + 3);
    for (size_t i = before; i < before + 3; ++i) {
      const MotionMessage &a = fuzzed.motions()[i], &b = plain.motions()[i];
      EXPECT_EQ(a.features, b.features);
      EXPECT_EQ(a.tracked, b.tracked);
      EXPECT_EQ(a.velocity_x, b.velocity_x);
      EXPECT_EQ(a.velocity_y, b.velocity_y);
      EXPECT_EQ(a.wrench.force_N, b.wrench.force_N);
      tracked += a.tracked;
    }
  }
  EXPECT_TRUE(fuzzed.warnings().empty()) << fuzzed.warnings()[0];
  EXPECT_GT(tracked, films) << "nothing was compared with nothing";
}

/// A frame that claims to have more memory than it has.
void spoil(GstBuffer* frame, RandomSource& random) {
  GstVideoMeta* meta = gst_buffer_get_video_meta(frame);
  // Of several planes in one memory only the last has nothing behind it.
  const guint plane = gst_buffer_n_memory(frame) == 1
                          ? meta->n_planes - 1
                          : static_cast<guint>(random.below(meta->n_planes));
  switch (random.below(4)) {
    case 0:
      gst_buffer_resize(frame, 0, static_cast<gssize>(random.below(gst_buffer_get_size(frame))));
      break;
    case 1:
      meta->stride[plane] += static_cast<gint>(1 + random.below(1000));
      break;
    case 2:
      meta->stride[plane] = -meta->stride[plane];
      break;
    default:
      meta->offset[plane] += 1 + random.below(100000);
      break;
  }
}

TEST(FrameFuzz, AFrameThatHasLessThanItSaysIsPassedOnWithAWarning) {
  const uint64_t seed = number_from("SPIDAR_SEED", 1);
  RandomSource random(seed);
  GstClockTime pts = 0;
  for (int n = 0; n < 200 && !testing::Test::HasFailure(); ++n) {
    const std::string format = random.one_of(video_formats());
    const int width = static_cast<int>(random.between(16, 60));
    const int height = static_cast<int>(random.between(16, 60));
    SCOPED_TRACE("SPIDAR_SEED=" + std::to_string(seed) + ", frame " + std::to_string(n) + ": " +
                 format + " " + std::to_string(width) + "x" + std::to_string(height));
    ElementHarness h(random.chance(0.5) ? "device=none" : "device=none overlay=points");
    h.set_caps(make_caps(format.c_str(), width, height));
    FrameLayout layout = random_layout(h.info(), random);
    // With nothing between lines and planes, whatever is changed is wrong.
    std::fill_n(layout.before, layout.planes, 0);
    const GreyPicture picture = picture_of(width, height, 0, 0);
    GstBuffer* frame = make_guarded_frame(h.info(), picture, layout, random);
    spoil(frame, random);
    h.push(frame, pts += kFrame);
    EXPECT_TRUE(h.motions().empty()) << "it was measured all the same";
    EXPECT_EQ(h.warnings().size() + h.errors().size(), 1u);
    h.push(make_guarded_frame(h.info(), picture, layout, random), pts += kFrame);
    EXPECT_EQ(h.motions().size(), 1u) << "the next one is well";
  }
}

}  // namespace
}  // namespace spidar::test::frame_fuzz_test
