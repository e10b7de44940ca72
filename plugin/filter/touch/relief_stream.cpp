// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/touch/relief_stream.h"

#include <algorithm>
#include <stdexcept>

#include "spidar/loop/stiffness_limit.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::filter {
namespace {

const MovingObject* object_at(const std::vector<MovingObject>& objects,
                              const Eigen::Vector2d& at_px) {
  const MovingObject* found = nullptr;
  for (const MovingObject& object : objects) {
    const Eigen::Array2d away_px = (at_px - object.position_px).array().abs();
    const bool inside = (away_px <= 0.5 * object.size_px.array()).all();
    if (!inside || object.points == 0) continue;
    if (found == nullptr || object.area_px2 < found->area_px2) found = &object;
  }
  return found;
}

/// The fewest picture samples that are read per relief sample in each direction. Two samples
/// capture everything that the relief can show, and keep the cost independent of the picture size.
constexpr int kReadPerCell = 2;

int step_of(int samples, int cells) {
  return std::max(1, samples / (kReadPerCell * cells));
}

}  // namespace

Eigen::Vector2d touched_displacement_px(const Frame& frame, const Eigen::Vector2d& position) {
  if (frame.picture == FrameComparison::kFirst || is_again(frame.picture) ||
      frame.interval_ns <= 0) {
    return Eigen::Vector2d::Zero();
  }
  const double passed_s = 1e-9 * static_cast<double>(frame.interval_ns);
  const Eigen::Vector2d at_px = frame.place.film_px(position);
  const Eigen::Array2d film_px(frame.width(), frame.height());
  // Outside the film.
  if ((2 * at_px.array().abs() > film_px).any()) return Eigen::Vector2d::Zero();
  const MovingObject* const object = object_at(frame.objects, at_px);
  if (object != nullptr) return passed_s * object->on_screen_px_s;
  if (frame.background) return frame.background->model.displacement_px(at_px);
  return passed_s * frame.motion.velocity_px_s;
}

touch::ContactSettings contact_settings(const TouchProperties& properties, const Profile& profile) {
  touch::ContactSettings contact;
  contact.stiffness_N_m = std::min(properties.stiffness_N_m, most_stiffness_N_m(profile));
  contact.delay_s = surface_delay_s(assumed_lag_s(profile));
  contact.friction = properties.friction;
  contact.texture = properties.texture;
  validate(contact);
  return contact;
}

void ReliefStream::connect(HapticLoop* loop, const Profile& profile,
                           const Eigen::Vector2d& half_size_m) {
  loop_ = loop;
  profile_ = profile;
  half_size_m_ = half_size_m;
  reliefs_ = reliefs_left_out_ = 0;
  stiffness_N_m_ = 0;
}

void ReliefStream::disconnect() {
  const std::lock_guard<std::mutex> lock(mutex_);
  loop_ = nullptr;
  mailbox_.reset();
  touched_ = false;
}

void ReliefStream::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (mailbox_) mailbox_->clear();
}

void ReliefStream::set_muted(bool muted) {
  muted_ = muted;
  if (muted) clear();
}

void ReliefStream::start() {
  if (!(half_size_m_.minCoeff() > 0)) {
    throw std::invalid_argument(
        "touch: the profile's string exits span no width or no height, so "
        "that the picture has no size; another profile, or touch=off");
  }
  auto mailbox =
      std::make_unique<touch::Mailbox>(2 * half_size_m_.x(), 2 * half_size_m_.y(), kSlots);
  loop_->connect_touch(mailbox.get());
  const std::lock_guard<std::mutex> lock(mutex_);
  mailbox_ = std::move(mailbox);
}

/// The shown picture, subsampled if it is larger than the relief needs.
ImageView ReliefStream::thinned(const ImageView& luma) {
  const int columns = turn_.is_sideways() ? luma.height : luma.width;
  const int rows = turn_.is_sideways() ? luma.width : luma.height;
  const int down = step_of(rows, touch::HeightField::kRows);
  const int across = step_of(columns, touch::HeightField::kColumns);
  ImageView thin = luma;
  thin.height = (rows + down - 1) / down;
  thin.stride_bytes = down * luma.stride_bytes;
  if (across == 1 && turn_.is_none()) return thin;  // read in place
  const int bytes = luma.sample.bytes;
  thin.width = (columns + across - 1) / across;
  thinned_.resize(static_cast<size_t>(thin.width) * static_cast<size_t>(thin.height * bytes));
  // Steps in the memory of the frame to the right and down in the shown picture.
  const auto step_to = [&](double x, double y) {
    const Eigen::Vector2i step = turn_.to_stored(Eigen::Vector2d(x, y)).cast<int>();
    return step.x() * bytes + step.y() * luma.stride_bytes;
  };
  const ptrdiff_t right = across * step_to(1, 0), lower = down * step_to(0, 1);
  const Eigen::Vector2i corner = turn_.stored_position({0, 0}).cast<int>();
  const uint8_t* const first =
      luma.at(corner.x() * (luma.width - 1), corner.y() * (luma.height - 1));
  uint8_t* to = thinned_.data();
  for (int y = 0; y < thin.height; ++y) {
    for (int x = 0; x < thin.width; ++x) {
      const uint8_t* const from = first + y * lower + x * right;
      for (int byte = 0; byte < bytes; ++byte) *to++ = from[byte];
    }
  }
  thin.data = thinned_.data();
  thin.stride_bytes = thin.width * bytes;
  return thin;
}

/// Turns `levels` of a depth image as the picture is shown.
const float* ReliefStream::turned(const float* levels) {
  if (turn_.is_none()) return levels;
  constexpr int kColumns = touch::HeightField::kColumns, kRows = touch::HeightField::kRows;
  turned_levels_.resize(touch::HeightField::kCells);
  float* to = turned_levels_.data();
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const Eigen::Vector2d position =
          turn_.stored_position({(x + 0.5) / kColumns, (y + 0.5) / kRows});
      const int column = static_cast<int>(position.x() * kColumns);
      *to++ = levels[static_cast<int>(position.y() * kRows) * kColumns + column];
    }
  }
  return turned_levels_.data();
}

/// Fills in the surface of a frame. Returns false when the frame has no pixels.
bool ReliefStream::build(const ImageView& luma, int64_t shown_ns, const TouchProperties& properties,
                         touch::Surface& frame) {
  touch::ReliefSettings settings;
  settings.relief_m = 1e-3 * properties.relief_mm;
  settings.floor_z_m = -0.5 * settings.relief_m;
  settings.black_grey = levels_.black;
  settings.white_grey = levels_.white;
  validate(settings);
  if (const std::optional<touch::DepthLayout> layout = properties.packed()) {
    // At the beginning and after a seek, the depth range is estimated from this frame alone.
    const bool follows = depth_ns_ != INT64_MIN && shown_ns > depth_ns_;
    if (!follows) depth_.reset();
    const double dt_s = follows ? 1e-9 * static_cast<double>(shown_ns - depth_ns_) : 0;
    if (!depth_.read(touch::depth_half(luma, *layout), {true, -1, -1, false}, dt_s) ||
        !builder_.from_levels(turned(depth_.levels()), settings, frame.relief)) {
      return false;
    }
    depth_ns_ = shown_ns;
  } else if (!builder_.from_brightness(thinned(luma), settings, frame.relief)) {
    return false;
  }
  frame.has_texture = properties.texture > 0;
  if (frame.has_texture) builder_.fine_detail(settings, frame.texture);
  return true;
}

void ReliefStream::add(const ImageView& luma, const Frame& analyzed, int64_t shown_ns,
                       const TouchProperties& properties, const Eigen::Vector2d& finger,
                       std::string* shading) {
  if (!loop_) return;
  if (properties.kind == TouchProperties::Kind::kOff) {
    end(shown_ns);
    return;
  }
  if (!mailbox_) start();
  // The order matters: a mute or flush after this line drops this frame.
  const uint32_t generation = mailbox_->generation();
  if (muted_) return;
  const int64_t begin_ns = monotonic_now_ns();
  touch::Surface* const frame = mailbox_->begin(generation);
  if (!frame) {
    ++reliefs_left_out_;
    left_out_ = true;
    return;
  }
  if (!build(luma, shown_ns, properties, *frame)) {
    left_out_ = true;  // the surface between the neighbouring frames is unknown
    return;
  }
  frame->time_ns = shown_ns;
  frame->has_surface = true;
  frame->contact = contact_settings(properties, profile_);
  const Eigen::Vector2d moved_px = touched_displacement_px(analyzed, finger);
  const Eigen::Vector2d moved = turn_.to_displayed(Eigen::Vector2d(
      moved_px.x() / analyzed.place.picture_width, moved_px.y() / analyzed.place.picture_height));
  frame->displacement_m = {moved.x() * frame->relief.width_m(),
                           -moved.y() * frame->relief.height_m()};
  stiffness_N_m_ = frame->contact.stiffness_N_m;
  if (shading) *shading = frame->relief.shading();
  frame->follows =
      touched_ && !left_out_ && generation == generation_ && analyzed.has_motion_before();
  mailbox_->publish();
  touched_ = true;
  left_out_ = false;
  generation_ = generation;
  ++reliefs_;
  took_.add(monotonic_now_ns() - begin_ns);
}

void ReliefStream::end(int64_t shown_ns) {
  if (!mailbox_ || !touched_) return;
  touched_ = false;
  touch::Surface* const frame = mailbox_->begin(mailbox_->generation());
  if (!frame) {
    mailbox_->clear();
    return;
  }
  frame->time_ns = shown_ns;
  frame->has_surface = false;
  frame->follows = false;
  mailbox_->publish();
}

void ReliefStream::describe(FieldSink& to) const {
  to("reliefs", "", reliefs_.load(), "reliefs that `touch` made of frames");
  to("reliefs-left-out", "", reliefs_left_out_.load(),
     "reliefs that found no room, because more than 30 frames were on their way to the screen");
  to("relief", "ns", Parts{{"median", took_.quantile_ns(0.5)}}, "time of a relief: `median`");
  to("touch-stiffness", "N/m", stiffness_N_m_.load(),
     "stiffness as rendered: less than the property where drives are slow or were not measured");
}

}  // namespace spidar::filter
