// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/motion_meta.h"

#include <limits>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <gst-spidar/gstspidarmotionmeta.h>

#include "plugin/frame/frame_fields.h"
#include "plugin/gobject/ref.h"
#include "plugin/gobject/structure_fields.h"

namespace spidar::filter {
namespace {

GstStructure* add_meta(GstBuffer* buffer) {
  GstCustomMeta* meta = gst_buffer_add_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  return gst_custom_meta_get_structure(meta);
}

GstStructure* structure_of(GstBuffer* buffer) {
  GstCustomMeta* const meta = gst_buffer_get_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  return gst_custom_meta_get_structure(meta);
}

GstStructure* add_copy(GstBuffer* to, GstBuffer* from) {
  GstStructure* const copy = add_meta(to);
  gst_structure_foreach(
      structure_of(from),
      [](GQuark field, const GValue* value, gpointer target) -> gboolean {
        gst_structure_id_set_value(static_cast<GstStructure*>(target), field, value);
        return TRUE;
      },
      copy);
  return copy;
}

/// A point as GVariant serialises "(uddddu)": doubles at multiples of eight bytes, zero padding.
struct SerialisedPoint {
  guint32 id, zero_after_id;
  gdouble from_x, from_y, to_x, to_y;
  guint32 object, zero_after_object;
};
static_assert(sizeof(SerialisedPoint) == 48);

void set_points(GstStructure* structure, const std::vector<SerialisedPoint>& points) {
  // One array: a GVariant for each number would take longer than the analysis of motion.
  GVariant* array = g_variant_new_fixed_array(
      g_variant_type_element(G_VARIANT_TYPE(GST_SPIDAR_MOTION_POINTS_TYPE)), points.data(),
      points.size(), sizeof(SerialisedPoint));
  gst_structure_set(structure, "points", G_TYPE_VARIANT, array, nullptr);
}

/// Writes the values that depend on the geometry of the picture.
void set_mapped(GstStructure* structure, const GstSpidarFrameMotion& m, const PicturePart& film) {
  gst_structure_set(structure, "width", G_TYPE_UINT, m.width, "height", G_TYPE_UINT, m.height,
                    "velocity-x", G_TYPE_DOUBLE, m.velocity_x, "velocity-y", G_TYPE_DOUBLE,
                    m.velocity_y, "roll", G_TYPE_DOUBLE, m.roll, "force-x", G_TYPE_DOUBLE,
                    m.force_x, "force-y", G_TYPE_DOUBLE, m.force_y, "torque-x", G_TYPE_DOUBLE,
                    m.torque_x, "torque-y", G_TYPE_DOUBLE, m.torque_y, "torque-z", G_TYPE_DOUBLE,
                    m.torque_z, nullptr);
  StructureFields to(structure, kInMeta);
  area_fields(film, to);
}

/// Maps `position`, where (0, 0) is the centre of the first pixel.
Eigen::Vector2d mapped(const Eigen::Matrix3d& map, const Eigen::Vector2d& position) {
  const Eigen::Vector2d half{0.5, 0.5};
  return (map * (position + half).homogeneous()).hnormalized() - half;
}

/// The pixels of the picture `out` that show the film of `from`; turns are by right angles.
PicturePart mapped_area(const Eigen::Matrix3d& map, GstBuffer* from, const GstVideoInfo& out) {
  guint x = 0, y = 0, width = 0, height = 0;
  if (!gst_structure_get(structure_of(from), "area-x", G_TYPE_UINT, &x, "area-y", G_TYPE_UINT, &y,
                         "area-width", G_TYPE_UINT, &width, "area-height", G_TYPE_UINT, &height,
                         nullptr)) {
    return {};
  }
  const Eigen::Array2d size_px(GST_VIDEO_INFO_WIDTH(&out), GST_VIDEO_INFO_HEIGHT(&out));
  const auto corner = [&](double at_x, double at_y) -> Eigen::Array2d {
    const Eigen::Vector2d to = (map * Eigen::Vector3d(at_x, at_y, 1)).hnormalized();
    if (!to.allFinite()) return Eigen::Array2d::Zero();
    return to.array().round().max(0.0).min(size_px);
  };
  const Eigen::Array2d a = corner(x, y), b = corner(x + width, y + height);
  const Eigen::Array2i low = a.min(b).cast<int>(), high = a.max(b).cast<int>();
  return {low.x(), low.y(), high.x() - low.x(), high.y() - low.y()};
}

/// The Jacobian of `map` at `position`.
Eigen::Matrix2d linear_at(const Eigen::Matrix3d& map, const Eigen::Vector2d& position) {
  const Eigen::Vector3d to = map * position.homogeneous();
  const Eigen::Vector2d at = to.hnormalized();
  return (map.topLeftCorner<2, 2>() - at * map.row(2).head<2>()) / to.z();
}

/// The rotation or reflection nearest to `linear`: the orthogonal factor of its polar decomposition
/// (N. J. Higham, SIAM J. Sci. Stat. Comput. 7, 1986). Nothing where `linear` is not finite or maps
/// the picture to a line.
std::optional<Eigen::Matrix2d> turn_in(const Eigen::Matrix2d& linear) {
  if (!linear.allFinite()) return std::nullopt;
  Eigen::JacobiSVD<Eigen::Matrix2d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(std::numeric_limits<gfloat>::epsilon());  // the map itself is no more exact
  if (svd.rank() < 2) return std::nullopt;
  return svd.matrixU() * svd.matrixV().transpose();
}

/// Applies `map` to the motion. Velocities are scaled; force and torque are only turned and
/// mirrored. Returns false if `map` is singular at the centre of the picture.
bool map_motion(const Eigen::Matrix3d& map, GstSpidarFrameMotion& m) {
  const Eigen::Matrix2d linear = linear_at(map, Eigen::Vector2d(m.width, m.height) / 2);
  const Eigen::Vector2d velocity = linear * Eigen::Vector2d(m.velocity_x, m.velocity_y);
  const std::optional<Eigen::Matrix2d> turn = turn_in(linear);
  if (!turn) return false;
  // y of force and torque points up. A torque is an axial vector.
  const double side = turn->determinant();
  const Eigen::Vector2d force = *turn * Eigen::Vector2d(m.force_x, -m.force_y);
  const Eigen::Vector2d torque = side * (*turn * Eigen::Vector2d(m.torque_x, -m.torque_y));
  m.velocity_x = velocity.x();
  m.velocity_y = velocity.y();
  m.force_x = force.x();
  m.force_y = -force.y();
  m.torque_x = torque.x();
  m.torque_y = -torque.y();
  m.torque_z *= side;
  m.roll *= side;
  return true;
}

/// Copies the meta of `from` to `to`, whose picture has been made from that of `from` by `map`.
bool copy_mapped(GstBuffer* to, GstBuffer* from, const Eigen::Matrix3d& map,
                 const GstVideoInfo& out) {
  GstSpidarFrameMotion motion;
  const Ref<GArray> points(gst_buffer_get_spidar_points(from));
  if (!points || !gst_buffer_get_spidar_motion(from, &motion) || !map_motion(map, motion)) {
    return false;
  }
  motion.width = static_cast<guint>(GST_VIDEO_INFO_WIDTH(&out));
  motion.height = static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&out));
  std::vector<SerialisedPoint> moved;
  for (guint i = 0; i < points->len; ++i) {
    const GstSpidarMotionPoint& point = g_array_index(points.get(), GstSpidarMotionPoint, i);
    const Eigen::Vector2d before = mapped(map, {point.from_x, point.from_y});
    const Eigen::Vector2d now = mapped(map, {point.to_x, point.to_y});
    if (!before.allFinite() || !now.allFinite()) continue;  // the point is at the horizon
    moved.push_back({point.id, 0, before.x(), before.y(), now.x(), now.y(), point.object, 0});
  }
  GstStructure* const structure = add_copy(to, from);
  set_mapped(structure, motion, mapped_area(map, from, out));
  set_points(structure, moved);
  return true;
}

Eigen::Matrix3d map_of(const GstVideoMetaTransform& scale) {
  const GstVideoInfo &in = *scale.in_info, &out = *scale.out_info;
  const Eigen::Vector3d factors(
      static_cast<double>(GST_VIDEO_INFO_WIDTH(&out)) / GST_VIDEO_INFO_WIDTH(&in),
      static_cast<double>(GST_VIDEO_INFO_HEIGHT(&out)) / GST_VIDEO_INFO_HEIGHT(&in), 1);
  return factors.asDiagonal();
}

Eigen::Matrix3d map_of(const MatrixTransform& transform) {
  const auto moved = [](double x, double y) {
    Eigen::Matrix3d move = Eigen::Matrix3d::Identity();
    move.topRightCorner<2, 1>() << x, y;
    return move;
  };
  const Eigen::Map<const Eigen::Matrix<gfloat, 3, 3, Eigen::RowMajor>> inside(
      &transform.matrix[0][0]);
  const GstVideoRectangle &in = transform.in_rectangle, &out = transform.out_rectangle;
  return moved(out.x, out.y) * inside.cast<double>() * moved(-in.x, -in.y);
}

gboolean transform(GstBuffer* to, GstCustomMeta*, GstBuffer* from, GQuark type, gpointer data,
                   gpointer) {
  if (GST_META_TRANSFORM_IS_COPY(type)) {
    const auto* copy = static_cast<const GstMetaTransformCopy*>(data);
    if (copy->region) return FALSE;  // the picture is incomplete in a part of the buffer
    add_copy(to, from);
    return TRUE;
  }
  if (GST_VIDEO_META_TRANSFORM_IS_SCALE(type)) {
    const auto& scale = *static_cast<const GstVideoMetaTransform*>(data);
    return copy_mapped(to, from, map_of(scale), *scale.out_info);
  }
  if (type == matrix_transform()) {
    const auto& matrix = *static_cast<const MatrixTransform*>(data);
    return copy_mapped(to, from, map_of(matrix), *matrix.out_info);
  }
  return FALSE;
}

}  // namespace

void register_motion_meta() {
  static const bool registered = [] {
    // An element that changes one of these calls transform() or drops the meta.
    const gchar* tags[] = {GST_META_TAG_VIDEO_STR, GST_META_TAG_VIDEO_SIZE_STR,
                           GST_META_TAG_VIDEO_ORIENTATION_STR, nullptr};
    return gst_meta_register_custom(GST_SPIDAR_MOTION_META_NAME, tags, transform, nullptr,
                                    nullptr) != nullptr;
  }();
  (void)registered;
}

void attach_motion_meta(GstBuffer* buffer, const DrawnFrame& report, int width, int height) {
  GstCustomMeta* before = gst_buffer_get_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  if (before) gst_buffer_remove_meta(buffer, reinterpret_cast<GstMeta*>(before));
  GstStructure* structure = add_meta(buffer);
  StructureFields to(structure, kInMeta);
  frame_fields(report, {0, 0, static_cast<guint>(width), static_cast<guint>(height)}, to);
  std::vector<SerialisedPoint> points;
  points.reserve(report.points.size());
  for (const OwnedPoint& point : report.points) {
    points.push_back({point.id, 0, point.from.x_px, point.from.y_px, point.to.x_px, point.to.y_px,
                      point.object, 0});
  }
  set_points(structure, points);
}

}  // namespace spidar::filter
