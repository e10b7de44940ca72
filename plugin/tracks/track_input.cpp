// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_input.h"

#include <algorithm>
#include <cmath>

#include "plugin/gobject/ref.h"
#include "plugin/timing/instant_rate.h"

namespace spidar::tracks {
namespace {

constexpr guint64 kMaskOf5_1 = 0x3f;

bool has_no_mask(const GstCaps* caps) {
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  return gst_structure_has_name(structure, "audio/x-raw") &&
         !gst_structure_has_field(structure, "channel-mask");
}

/// Returns the channel mask as text. Empty if there is no mask, or if it is that of 5.1, which
/// containers set if there is none.
std::string unsupported_mask(const GstCaps* caps) {
  guint64 mask = 0;
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  if (!gst_structure_get(structure, "channel-mask", GST_TYPE_BITMASK, &mask, nullptr)) return {};
  if (mask == 0 || mask == kMaskOf5_1) return {};
  return taken(g_strdup_printf("0x%" G_GINT64_MODIFIER "x", mask));
}

}  // namespace

std::string Input::set_caps(const GstCaps* caps) {
  GstAudioInfo info;
  if (!gst_audio_info_from_caps(&info, caps)) {
    // sfdec, which has no mask, also scales floats wrongly and adds samples at the end.
    return has_no_mask(caps)
               ? "What has decoded this names no channel-mask, so that it is not known which "
                 "channel "
                 "is which: a haptic track has 0 or 0x3f. Make WAV, FLAC or Matroska of it."
               : "These caps are not raw sound.";
  }
  const int channels = GST_AUDIO_INFO_CHANNELS(&info);
  const int rate_Hz = GST_AUDIO_INFO_RATE(&info);
  if (channels != static_cast<int>(kTrackChannels)) {
    return "Sound of " + std::to_string(channels) + (channels == 1 ? " channel" : " channels") +
           " is not a haptic track: it has 6, force x, y, z and torque x, y, z.";
  }
  if (rate_Hz < kLowestRate_Hz || rate_Hz > kHighestRate_Hz) {
    return "A haptic track has from " + std::to_string(kLowestRate_Hz) + " to " +
           std::to_string(kHighestRate_Hz) + " samples a second, best 1000, not " +
           std::to_string(rate_Hz) + ".";
  }
  const std::string mask = unsupported_mask(caps);
  if (!mask.empty()) {
    return "The channel-mask " + mask +
           " may have moved the axes of a haptic track to other channels: it has to be 0 or 0x3f.";
  }
  info_ = info;
  thinner_.begin(rate_Hz);
  band_ = Band(rate_Hz / static_cast<double>(thinner_.group()));
  reset();
  return {};
}

void Input::reset() {
  thinner_.reset();
  next_pts_ = end_ = GST_CLOCK_TIME_NONE;
}

bool Input::unpack(GstBuffer* buffer) {
  const bool planar = GST_AUDIO_INFO_LAYOUT(&info_) == GST_AUDIO_LAYOUT_NON_INTERLEAVED;
  const auto sample_bytes = static_cast<size_t>(GST_AUDIO_INFO_BPF(&info_)) / kTrackChannels;
  const GstAudioMeta* meta = planar ? gst_buffer_get_audio_meta(buffer) : nullptr;
  const size_t count = samples_in(buffer);
  GstMapInfo map;
  if (!gst_buffer_map(buffer, &map, GST_MAP_READ)) return false;
  doubles_.resize(count * kTrackChannels);
  bool fits = true;
  if (!planar) {
    unpack(map.data, count * kTrackChannels, doubles_.data());
  } else {
    plane_.resize(count);
    for (size_t channel = 0; channel < kTrackChannels; ++channel) {
      // Without this meta the planes follow each other.
      const size_t offset = meta ? meta->offsets[channel] : channel * count * sample_bytes;
      fits = fits && offset <= map.size && count * sample_bytes <= map.size - offset;
      if (!fits) break;
      unpack(map.data + offset, count, plane_.data());
      for (size_t i = 0; i < count; ++i) doubles_[i * kTrackChannels + channel] = plane_[i];
    }
  }
  gst_buffer_unmap(buffer, &map);
  return fits;
}

size_t Input::samples_in(GstBuffer* buffer) const {
  const bool planar = GST_AUDIO_INFO_LAYOUT(&info_) == GST_AUDIO_LAYOUT_NON_INTERLEAVED;
  const GstAudioMeta* meta = planar ? gst_buffer_get_audio_meta(buffer) : nullptr;
  return meta ? meta->samples
              : gst_buffer_get_size(buffer) / static_cast<size_t>(GST_AUDIO_INFO_BPF(&info_));
}

void Input::unpack(const guint8* from, size_t values, double* to) {
  const GstAudioFormatInfo* format = info_.finfo;
  const bool floats = GST_AUDIO_FORMAT_INFO_IS_FLOAT(format);
  if (!floats) integers_.resize(values);
  // With this flag the missing bits of a smaller format become zeros; by default other bits are
  // repeated into them.
  format->unpack_func(format, GST_AUDIO_PACK_FLAG_TRUNCATE_RANGE,
                      floats ? static_cast<void*>(to) : integers_.data(), from,
                      static_cast<gint>(values));
  if (floats) return;
  constexpr double kFullScale = 2147483648.0;
  std::transform(integers_.begin(), integers_.end(), to,
                 [](gint32 value) { return value / kFullScale; });
}

TrackSample Input::sample(size_t i, double gain) {
  TrackSample sample;
  bool finite = true, beyond = false;
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    const double value = doubles_[i * kTrackChannels + channel];
    sample[channel] = static_cast<float>(gain * value);
    // A number of 64 bits may be too large for one of 32.
    finite = finite && std::isfinite(sample[channel]);
    beyond = beyond || std::fabs(value) > 1;
  }
  ++samples_;
  if (finite && beyond) ++faults_.beyond_full;
  if (finite) return sample;
  ++faults_.not_finite;
  return {};
}

GstFlowReturn Input::read(GstBuffer* buffer, const GstSegment& segment, double gain,
                          const std::function<GstFlowReturn(const TrackBlock&)>& give) {
  const int rate_Hz = GST_AUDIO_INFO_RATE(&info_);
  const size_t count = samples_in(buffer);
  const auto length = [rate_Hz](size_t samples) {
    return gst_util_uint64_scale_int(samples, GST_SECOND, rate_Hz);
  };
  GstClockTime pts = GST_BUFFER_PTS(buffer);
  if (!GST_CLOCK_TIME_IS_VALID(pts)) pts = next_pts_;
  if (segment.format != GST_FORMAT_TIME || !is_time(pts) || count == 0) return GST_FLOW_OK;
  if (pts != next_pts_) thinner_.reset();
  const bool backwards = segment.rate < 0;
  next_pts_ = backwards ? GST_CLOCK_TIME_NONE : pts + length(count);

  guint64 from = 0, to = 0;
  if (!gst_segment_clip(&segment, GST_FORMAT_TIME, pts, pts + length(count), &from, &to)) {
    return GST_FLOW_OK;
  }
  const GstClockTime begin =
      gst_segment_to_running_time(&segment, GST_FORMAT_TIME, backwards ? to : from);
  if (!is_time(begin)) return GST_FLOW_OK;
  const auto index = [&](GstClockTime time) {
    return std::min(count, static_cast<size_t>(
                               gst_util_uint64_scale_int_round(time - pts, rate_Hz, GST_SECOND)));
  };
  const size_t first = index(from), last = index(to);

  if (!unpack(buffer)) return GST_FLOW_ERROR;

  const double period_ns = 1e9 / rate_Hz / std::fabs(segment.rate);
  const double group = static_cast<double>(thinner_.group());
  const auto at_ns = [&](double samples_after_begin) {
    return static_cast<int64_t>(begin) + std::llround(samples_after_begin * period_ns);
  };
  TrackBlock block;
  for (size_t i = first; i < last; ++i) {
    TrackSample next = sample(backwards ? first + last - 1 - i : i, gain);
    if (thinner_.add(next)) {
      band_.add(next);
      if (block.count == 0) {
        // A mean belongs to the middle of its samples, of which the last one was just added. In
        // reverse playback the first sample ends where the buffer does.
        const double middle = static_cast<double>(i - first) - (group - 1) / 2;
        block.begin_ns = at_ns(backwards ? middle + 1 : middle);
      }
      block.samples[block.count++] = next;
    }
    if (block.count == TrackBlock::kCapacity || (i + 1 == last && block.count > 0)) {
      block.duration_ns =
          std::max<int64_t>(std::llround(static_cast<double>(block.count) * group * period_ns), 1);
      faults_.sound_channel = band_.sound_channel();
      const GstFlowReturn flow = give(block);
      if (flow != GST_FLOW_OK) return flow;
      block.count = 0;
    }
  }
  end_ = static_cast<GstClockTime>(at_ns(static_cast<double>(last - first)));
  return GST_FLOW_OK;
}

}  // namespace spidar::tracks
