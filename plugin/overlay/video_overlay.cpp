// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/overlay/video_overlay.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/force/motion_rendering.h"
#include "plugin/frame/point_owners.h"
#include "plugin/gobject/ref.h"
#include "plugin/overlay/arrow.h"
#include "spidar/text.h"

namespace spidar {
namespace {

constexpr Rgb kProxy{255, 160, 30}, kGrid{130, 130, 130}, kFilm{90, 200, 250};
/// The height of a number, as a fraction of the picture's.
constexpr double kNumberFraction = 0.035;
/// Heights in the strip with the curve, as fractions of the picture's height: the whole strip, its
/// part below 0 N, and the axis from 0 N to its end. kCurveEnd is where the curve ends, as a
/// fraction of the picture's width.
constexpr double kStripFraction = 0.17, kBelowFraction = 0.02, kCurveFraction = 0.12;
constexpr double kCurveEnd = 0.985;
constexpr double kStripOpacity = 0.5;  ///< how much of the picture shows through the strip

cv::Scalar bgra(Rgb color) {
  return {static_cast<double>(color.b), static_cast<double>(color.g), static_cast<double>(color.r),
          255};
}

int whole(double px) {
  return std::max(1, static_cast<int>(std::lround(px)));
}

/// With soft edges, OpenCV draws half a pixel more on either side.
int thickness(double width_px) {
  return whole(width_px - 1);
}

/// Turns a shown picture into the orientation in which the frame is stored.
cv::Mat to_stored_orientation(cv::Mat shown, const Orientation& turn) {
  const Eigen::Vector2d right = turn.to_stored(Eigen::Vector2d(1, 0));
  const Eigen::Vector2d down = turn.to_stored(Eigen::Vector2d(0, 1));
  if (turn.is_sideways()) cv::transpose(shown, shown);
  const bool is_mirrored = (turn.is_sideways() ? down : right).x() < 0;
  const bool is_upside_down = (turn.is_sideways() ? right : down).y() < 0;
  if (is_mirrored) cv::flip(shown, shown, 1);
  if (is_upside_down) cv::flip(shown, shown, 0);
  return shown;
}

/// Blends into a copy of the frame with some spare bytes, and copies the result back: GStreamer's
/// functions read and write some bytes beyond the end of a line, where the memory of a frame may
/// end.
void blend_safely(GstVideoOverlayComposition* composition, GstVideoFrame& frame) {
  constexpr gsize kRoom = 256;
  GstVideoInfo roomy;
  gst_video_info_set_format(&roomy, GST_VIDEO_FRAME_FORMAT(&frame),
                            static_cast<guint>(GST_VIDEO_FRAME_WIDTH(&frame)),
                            static_cast<guint>(GST_VIDEO_FRAME_HEIGHT(&frame)));
  roomy.colorimetry = frame.info.colorimetry;
  const Ref<GstBuffer> buffer(
      gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&roomy) + kRoom, nullptr));
  GstVideoFrame copy;
  if (!gst_video_frame_map(&copy, &roomy, buffer.get(), GST_MAP_READWRITE)) return;
  gst_video_frame_copy(&copy, &frame);
  gst_video_overlay_composition_blend(composition, &copy);
  gst_video_frame_copy(&frame, &copy);
  gst_video_frame_unmap(&copy);
}

/// A transparent sheet over the visible part of a frame, in square pixels: (0, 0) is the centre of
/// the first one. Soft edges need premultiplied alpha.
class Sheet {
 public:
  Sheet(const GstVideoFrame& frame, const PicturePart& visible)
      : visible_(visible), pixel_aspect_(pixel_aspect(frame.info)) {
    const double width_px = std::max(1.0, std::round(visible.width * pixel_aspect_));
    pixels_ = cv::Mat::zeros(visible.height, static_cast<int>(width_px), CV_8UC4);
  }

  /// Maps a position from pixels of the frame to those of the sheet, whose left edges coincide.
  Eigen::Vector2d at_px(const Eigen::Vector2d& frame_px) const {
    return {(frame_px.x() - visible_.x + 0.5) * pixel_aspect_ - 0.5, frame_px.y() - visible_.y};
  }
  Eigen::Vector2d size_px() const { return {pixels_.cols, pixels_.rows}; }

  void line(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double width_px,
            Rgb color) {
    if (!is_near(from_px) || !is_near(to_px)) return;
    cv::line(pixels_, fixed(from_px), fixed(to_px), bgra(color), thickness(width_px), cv::LINE_AA,
             kShift);
  }
  /// Draws a filled triangle, and its outline if `outline_px` > 0.
  void triangle(const std::array<Eigen::Vector2d, 3>& corners_px, double outline_px, Rgb color) {
    std::vector<cv::Point> corners;
    for (const Eigen::Vector2d& corner_px : corners_px) {
      if (!is_near(corner_px)) return;
      corners.push_back(fixed(corner_px));
    }
    cv::fillConvexPoly(pixels_, corners, bgra(color), cv::LINE_AA, kShift);
    if (outline_px > 0) {
      cv::polylines(pixels_, corners, true, bgra(color), thickness(outline_px), cv::LINE_AA,
                    kShift);
    }
  }
  /// Darkens the picture between two corners.
  void shade(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double opacity) {
    if (!is_near(from_px) || !is_near(to_px)) return;
    cv::rectangle(pixels_, fixed(from_px), fixed(to_px), {0, 0, 0, 255 * opacity}, cv::FILLED,
                  cv::LINE_8, kShift);
  }
  void box(const Eigen::Vector2d& low_px, const Eigen::Vector2d& high_px, double width_px,
           Rgb color) {
    if (!is_near(low_px) || !is_near(high_px)) return;
    cv::rectangle(pixels_, fixed(low_px), fixed(high_px), bgra(color), whole(width_px), cv::LINE_8,
                  kShift);
  }
  /// Draws a ring, or a disc if `width_px` is 0.
  void circle(const Eigen::Vector2d& centre_px, double radius_px, double width_px, Rgb color) {
    if (!is_near(centre_px) || !(radius_px >= 0) || radius_px > kFar_px) return;
    const auto radius = static_cast<int>(std::lround(radius_px * (1 << kShift)));
    cv::circle(pixels_, fixed(centre_px), radius, bgra(color),
               width_px > 0 ? thickness(width_px) : cv::FILLED, cv::LINE_AA, kShift);
  }
  /// Draws text that is upright in the shown picture. The text begins at `beyond_px` and extends in
  /// the direction `along`; if it does not fit there, it is moved into the sheet.
  void text(const std::string& text, const Eigen::Vector2d& beyond_px, const Eigen::Vector2d& along,
            const Orientation& turn);

  /// Blends the sheet into a frame of any format that is mapped for writing.
  void blend_into(GstVideoFrame& frame) const;

 private:
  static constexpr int kShift = 4;            // OpenCV expects whole numbers of 1/16 px
  static constexpr double kFar_px = 1 << 20;  // no overflow, and nothing there is visible

  static bool is_near(const Eigen::Vector2d& px) {
    return px.allFinite() && px.cwiseAbs().maxCoeff() < kFar_px;
  }
  static cv::Point fixed(const Eigen::Vector2d& px) {
    const double unit = 1 << kShift;
    return {static_cast<int>(std::lround(px.x() * unit)),
            static_cast<int>(std::lround(px.y() * unit))};
  }

  PicturePart visible_;
  double pixel_aspect_;
  cv::Mat pixels_;
};

void Sheet::text(const std::string& text, const Eigen::Vector2d& beyond_px,
                 const Eigen::Vector2d& along, const Orientation& turn) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  const double height_px = kNumberFraction * visible_.height;
  const int line = whole(height_px / 7), margin = 2 * line;
  const double scale = cv::getFontScaleFromHeight(kFont, whole(height_px), line);
  int below = 0;
  const cv::Size size = cv::getTextSize(text, kFont, scale, line, &below);
  cv::Mat label = cv::Mat::zeros(size.height + 2 * margin, size.width + 2 * margin, pixels_.type());
  const cv::Point left(margin, margin + size.height);
  cv::putText(label, text, left, kFont, scale, bgra(kBlack), 3 * line, cv::LINE_AA);
  cv::putText(label, text, left, kFont, scale, bgra(kWhite), line, cv::LINE_AA);
  label = to_stored_orientation(label, turn);
  const Eigen::Vector2d label_px(label.cols, label.rows);
  const Eigen::Vector2d most_px = size_px() - label_px;
  if (!is_near(beyond_px) || most_px.minCoeff() < 0) return;
  const Eigen::Vector2d corner_px =
      (beyond_px + along.cwiseProduct(label_px / 2) - label_px / 2).cwiseMin(most_px).cwiseMax(0.0);
  const cv::Rect position(static_cast<int>(corner_px.x()), static_cast<int>(corner_px.y()),
                          label.cols, label.rows);
  cv::Mat covered;
  cv::extractChannel(label, covered, 3);
  label.copyTo(pixels_(position), covered);
}

void Sheet::blend_into(GstVideoFrame& frame) const {
  cv::Mat covered;
  cv::extractChannel(pixels_, covered, 3);
  const cv::Rect drawn = cv::boundingRect(covered);
  if (drawn.empty()) return;
  // Whole rows are scaled, so that pixels that are not square begin at the left edge.
  const cv::Mat rows = pixels_.rowRange(drawn.y, drawn.y + drawn.height);
  const gsize bytes = rows.total() * rows.elemSize();
  GstBuffer* const buffer = gst_buffer_new_memdup(rows.data, bytes);
  gst_buffer_add_video_meta(buffer, GST_VIDEO_FRAME_FLAG_NONE,
                            GST_VIDEO_OVERLAY_COMPOSITION_FORMAT_RGB, static_cast<guint>(rows.cols),
                            static_cast<guint>(rows.rows));
  GstVideoOverlayRectangle* const rectangle = gst_video_overlay_rectangle_new_raw(
      buffer, visible_.x, visible_.y + drawn.y, static_cast<guint>(visible_.width),
      static_cast<guint>(rows.rows), GST_VIDEO_OVERLAY_FORMAT_FLAG_PREMULTIPLIED_ALPHA);
  GstVideoOverlayComposition* const composition = gst_video_overlay_composition_new(rectangle);
  blend_safely(composition, frame);
  gst_video_overlay_composition_unref(composition);
  gst_video_overlay_rectangle_unref(rectangle);
  gst_buffer_unref(buffer);
}

/// Draws an arrow, widened by `margin_px` on all sides.
void draw_arrow(const Arrow& arrow, double margin_px, Rgb color, Sheet& sheet) {
  const double width_px = arrow.width_px + 2 * margin_px;
  const std::optional<ArrowHead> head = head_of(arrow);
  if (!head) return sheet.circle(arrow.tail_px, width_px / 2, 0, color);
  sheet.line(arrow.tail_px, head->neck_px(), width_px, color);
  sheet.triangle(head->corners_px, 2 * margin_px, color);
}

void draw_felt(const Wrench& wrench, const ArrowStyle& style, Sheet& sheet) {
  const std::optional<Arrow> felt = felt_arrow(wrench, style);
  if (!felt) return;
  draw_arrow(*felt, felt->width_px / 4, kBlack, sheet);
  draw_arrow(*felt, 0, felt->color, sheet);
  const double force_N = wrench.force_N.norm();
  if (force_N < kFeltForce_N) return;
  const Eigen::Vector2d along = (felt->tip_px - felt->tail_px).normalized();
  sheet.text(formatted("%.1f N", force_N), felt->tip_px + 2 * felt->width_px * along, along,
             style.turn);
}

void draw_touch(const TouchMark& touch, const PicturePart& visible, ArrowStyle style,
                Sheet& sheet) {
  // Position 0 is the left edge of the first pixel, half a pixel from its centre.
  const auto at_px = [&](const Eigen::Vector2d& position) {
    return sheet.at_px({visible.x + position.x() * visible.width - 0.5,
                        visible.y + position.y() * visible.height - 0.5});
  };
  const double ring_px = finger_radius_px(style.height_px), line_px = ring_px / 4;
  const Eigen::Vector2d finger_px = at_px(touch.finger);
  sheet.circle(finger_px, ring_px - line_px / 2, 3 * line_px, kBlack);
  sheet.circle(finger_px, ring_px - line_px / 2, line_px, kWhite);
  if (!touch.touching) return;
  const double radius_px = proxy_radius_px(touch, style.max_force_N, style.height_px);
  style.centre_px = at_px(touch.proxy);
  Wrench wrench;
  wrench.force_N = touch.force_N;
  draw_felt(wrench, style, sheet);
  sheet.circle(style.centre_px, radius_px + line_px / 2, 0, kBlack);
  sheet.circle(style.centre_px, radius_px, 0, kProxy);
}

/// Draws the box of an object: thick and orange if the object is felt, else thin and white.
void draw_outline(const MovingObject& object, bool is_felt, const PicturePart& film, double thin_px,
                  Sheet& sheet) {
  const Eigen::AlignedBox2d box = box_px(object, film);
  const Eigen::Vector2d low_px = sheet.at_px(box.min()), high_px = sheet.at_px(box.max());
  if (!is_felt) return sheet.box(low_px, high_px, thin_px, kWhite);
  sheet.box(low_px, high_px, 4 * thin_px, kBlack);
  sheet.box(low_px, high_px, 2 * thin_px, kProxy);
}

/// Draws the curve along the lower edge of the shown picture, or, above subtitles, along the upper
/// one.
void draw_curve(const ForceCurve& curve, const DrawnFrame& report, Sheet& sheet) {
  const Orientation& turn = report.turn;
  const Eigen::Vector2d size_px = sheet.size_px();
  const double height_px = turn.is_sideways() ? size_px.x() : size_px.y();
  const double thin_px = height_px / kReferenceHeight_px;
  const auto at_px = [&](double x, double y) -> Eigen::Vector2d {
    return turn.stored_position(Eigen::Vector2d(x, y)).cwiseProduct(size_px).array() - 0.5;
  };
  const double lower_edge = report.has_subtitles ? kStripFraction : 1;
  const auto level_px = [&](double x, double fraction) {
    return at_px(x, lower_edge - kBelowFraction - kCurveFraction * fraction);
  };
  sheet.shade(at_px(0, lower_edge - kStripFraction), at_px(1, lower_edge), kStripOpacity);
  for (const double fraction : {0.0, 1.0}) {
    sheet.line(level_px(0, fraction), level_px(1, fraction), thin_px, kGrid);
  }
  std::optional<Eigen::Vector2d> before_px;
  for (const Eigen::Vector2d& position : curve.positions()) {
    const Eigen::Vector2d now_px = level_px(kCurveEnd * position.x(), position.y());
    if (before_px) sheet.line(*before_px, now_px, 3 * thin_px, kProxy);
    before_px = now_px;
  }
  if (before_px) sheet.circle(*before_px, 5 * thin_px, 0, kProxy);
  sheet.text(formatted("%g N", curve.axis().high), level_px(0, 1),
             turn.to_stored(Eigen::Vector2d(1, 0)), turn);
}

}  // namespace

void draw_overlay(const DrawnFrame& report, bool has_points, double scale, GstVideoFrame& frame,
                  const ForceCurve* curve) {
  const PicturePart& visible = report.visible;
  const std::vector<uint32_t>& felt = report.felt;
  Sheet sheet(frame, visible);
  ArrowStyle style;
  style.scale = scale;
  style.max_force_N = report.controller.max_force_N;
  style.turn = report.turn;
  style.height_px = visible.height;
  style.centre_px = sheet.at_px(force_origin_px(report));
  if (curve) draw_curve(*curve, report, sheet);
  if (has_points) {
    const auto at_px = [&](const ImagePoint& at) { return sheet.at_px({at.x_px, at.y_px}); };
    for (const Arrow& arrow : point_arrows(report.points, style, at_px)) {
      draw_arrow(arrow, 0, arrow.color, sheet);
    }
    const double half_px = felt_width_px(style) / 3;
    for (const ImagePoint& lost : report.lost) {
      const Eigen::Vector2d a(half_px, half_px), b(half_px, -half_px), lost_px = at_px(lost);
      sheet.line(lost_px - a, lost_px + a, half_px / 2, kWhite);
      sheet.line(lost_px - b, lost_px + b, half_px / 2, kWhite);
    }
  }
  const PicturePart film = report.film_part();
  const double thin_px = visible.height / kReferenceHeight_px;
  if (report.has_area()) {
    sheet.box(sheet.at_px(Eigen::Vector2d(film.x, film.y)),
              sheet.at_px(Eigen::Vector2d(film.x + film.width - 1, film.y + film.height - 1)),
              2 * thin_px, kFilm);
  }
  for (const MovingObject& object : report.frame.objects) {
    const bool is_felt = std::find(felt.begin(), felt.end(), object.id) != felt.end();
    if (object.points > 0) draw_outline(object, is_felt, film, thin_px, sheet);
  }
  draw_felt(report.frame.wrench, style, sheet);
  if (report.touch_mark) draw_touch(*report.touch_mark, visible, style, sheet);
  sheet.blend_into(frame);
}

}  // namespace spidar
