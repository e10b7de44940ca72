// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/films/film_reader.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "plugin/films/file_pipeline.h"
#include "plugin/films/stream_content.h"
#include "plugin/gobject/ref.h"

namespace spidar {
namespace {

std::pair<const uint8_t*, size_t> after_last_start_code(const uint8_t* data, size_t size) {
  for (size_t i = size; i >= 4; --i) {
    if (data[i - 4] == 0 && data[i - 3] == 0 && data[i - 2] == 1) {
      return {data + i - 1, size - i + 1};
    }
  }
  return {data, size};
}

std::pair<const uint8_t*, size_t> after_last_length(const uint8_t* data, size_t size,
                                                    size_t length_bytes) {
  std::pair<const uint8_t*, size_t> unit{data, size};
  for (size_t at = 0; at + length_bytes < size;) {
    size_t length = 0;
    for (size_t i = 0; i < length_bytes; ++i) length = length << 8 | data[at + i];
    at += length_bytes;
    if (length == 0 || length > size - at) return unit;
    unit = {data + at, length};
    at += length;
  }
  return unit;
}

/// Returns the largest power of two that is at most `size`.
size_t floor_to_power(size_t size) {
  size_t power = 1;
  while (power <= size / 2) power *= 2;
  return power;
}

constexpr int64_t kLongest_ns = 24 * 3600 * int64_t{1'000'000'000};  // a later timestamp is wrong
constexpr size_t kDigits = 16;  // of a hash: two films share one of 256 pictures once in 10^14

}  // namespace

PacketFraming framing_of(const GstCaps* caps) {
  PacketFraming framing;
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  const std::string name = gst_structure_get_name(structure);
  // In ISO/IEC 14496-15, the configuration states the size of the lengths.
  const bool is_hevc = name == "video/x-h265";
  if (name != "video/x-h264" && !is_hevc) return framing;
  const gchar* format = gst_structure_get_string(structure, "stream-format");
  if (!format || std::string(format) == "byte-stream") {
    framing.kind = PacketFraming::Kind::kStartCodes;
    return framing;
  }
  framing.kind = PacketFraming::Kind::kLengths;
  const GValue* value = gst_structure_get_value(structure, "codec_data");
  GstBuffer* configuration = value ? gst_value_get_buffer(value) : nullptr;
  guint8 lengths = 0;
  if (configuration && gst_buffer_extract(configuration, is_hevc ? 21 : 4, &lengths, 1) == 1) {
    framing.length_bytes = (lengths & 3u) + 1;
  }
  return framing;
}

std::string hash_packet(const uint8_t* data, size_t size, const PacketFraming& framing) {
  std::pair<const uint8_t*, size_t> unit{data, size};
  while (unit.second > 0 && unit.first[unit.second - 1] == 0 &&
         framing.kind != PacketFraming::Kind::kLengths) {
    --unit.second;
  }
  if (framing.kind == PacketFraming::Kind::kStartCodes) {
    unit = after_last_start_code(unit.first, unit.second);
  } else if (framing.kind == PacketFraming::Kind::kLengths) {
    unit = after_last_length(unit.first, unit.second, framing.length_bytes);
    while (unit.second > 0 && unit.first[unit.second - 1] == 0) --unit.second;
  }
  const size_t hashed = unit.second == 0 ? 0 : floor_to_power(unit.second);
  const uint8_t* const from = unit.first + unit.second - hashed;
  return taken(g_compute_checksum_for_data(G_CHECKSUM_SHA1, from, hashed)).substr(0, kDigits);
}

FilmFingerprint fingerprint_of(const std::vector<FilmPacket>& packets) {
  const auto largest =
      std::max_element(packets.begin(), packets.end(),
                       [](const FilmPacket& a, const FilmPacket& b) { return a.size < b.size; });
  if (largest == packets.end()) return {};
  return {largest->hash, largest->time_ns};
}

std::string to_text(const FilmFingerprint& fingerprint) {
  return std::to_string(fingerprint.time_ns) + ":" + fingerprint.hash;
}

FilmFingerprint parse_fingerprint(const std::string& text) {
  FilmFingerprint fingerprint;
  char* end = nullptr;
  fingerprint.time_ns = std::strtoll(text.c_str(), &end, 10);
  if (end == text.c_str() || *end != ':') return {};
  fingerprint.hash = end + 1;
  const bool is_time = fingerprint.time_ns > -kLongest_ns && fingerprint.time_ns < kLongest_ns;
  const bool is_hash = is_time && fingerprint.hash.size() == kDigits &&
                       fingerprint.hash.find_first_not_of("0123456789abcdef") == std::string::npos;
  return is_hash ? fingerprint : FilmFingerprint();
}

std::optional<int64_t> find_picture(const FilmFingerprint& fingerprint,
                                    const std::vector<FilmPacket>& packets) {
  std::optional<int64_t> later_ns;
  for (const FilmPacket& packet : packets) {
    if (packet.hash != fingerprint.hash) continue;
    // If several packets match, take the nearest one.
    const int64_t this_ns = packet.time_ns - fingerprint.time_ns;
    if (!later_ns || std::llabs(this_ns) < std::llabs(*later_ns)) later_ns = this_ns;
  }
  return later_ns;
}

namespace {

/// The fingerprint is chosen from this many packets, or from fewer if they are large.
constexpr size_t kStartPackets = 256;
constexpr size_t kStartBytes = size_t{8} << 20;
/// The most data from the last key frame to the end of the film.
constexpr size_t kEndBytes = size_t{64} << 20;
/// How far before the end of the container the end is searched: sound may be longer than the
/// pictures, and a demuxer without an index may land behind the last key frame.
constexpr int64_t kBeforeEnd_ns[] = {0, 20'000'000'000};
constexpr GstClockTime kLongestSearch = 10 * GST_SECOND;

class FilmReader {
 public:
  FilmReader(const std::string& path, const std::atomic<bool>* stopped)
      : file_("filesrc name=source ! parsebin name=parse", path, stopped),
        parser_(file_.find("parse")) {
    g_signal_connect(parser_, "pad-added", G_CALLBACK(on_pad_added), this);
    file_.link_streams([this](GstPad* pad) { return select_stream(pad); });
  }
  ~FilmReader() { file_.stop(); }
  FilmReader(const FilmReader&) = delete;
  FilmReader& operator=(const FilmReader&) = delete;

  Film read() {
    bool ended = file_.play_until(GST_MESSAGE_APPLICATION) == GST_MESSAGE_EOS;
    gint64 duration_ns = 0;
    if (sink_ && gst_element_query_duration(sink_, GST_FORMAT_TIME, &duration_ns)) {
      film_.duration_ns = duration_ns;
    }
    for (const int64_t before_ns : kBeforeEnd_ns) {
      if (ended || film_.duration_ns <= 0) break;
      ended = read_from(std::max<int64_t>(0, film_.duration_ns - before_ns));
    }
    missing_ = why_missing(parser_);
    file_.stop();
    return result(ended);
  }

 private:
  enum class Part { kStart, kEnd, kNone };

  /// Returns whether there were pictures until the end of the film.
  bool read_from(int64_t time_ns) {
    file_.pause();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      part_ = Part::kEnd;
      bytes_ = 0;
    }
    if (!seek_before(sink_, time_ns)) return false;
    const bool ended = file_.play_until(GST_MESSAGE_APPLICATION, kLongestSearch) == GST_MESSAGE_EOS;
    const std::lock_guard<std::mutex> lock(mutex_);
    return ended && bytes_ > 0;
  }

  Film result(bool ended) {
    if (film_.packets.empty()) throw std::runtime_error("there are no pictures in it" + missing_);
    std::sort(times_ns_.begin(), times_ns_.end());
    if (!times_ns_.empty()) film_.begin_ns = times_ns_.front();
    for (size_t i = 1; i < times_ns_.size(); ++i) {
      film_.frame_ns = std::max(film_.frame_ns, times_ns_[i] - times_ns_[i - 1]);
    }
    if (ended && !times_ns_.empty()) {
      film_.end_ns = last_ns_ + (last_length_ns_ > 0 ? last_length_ns_ : film_.frame_ns);
    }
    // A file that nothing parses comes in pieces, of which only the first has a time.
    film_.is_still = ended && streams_ == 1 &&
                     (film_.packets.size() == 1 || (is_cover_ && times_ns_.size() <= 1));
    return std::move(film_);
  }

  static void on_pad_added(GstElement*, GstPad* pad, gpointer user) {
    static_cast<FilmReader*>(user)->content_of_stream(pad);
  }

  /// Called when a pad is added and when its data flow: a track may be recognised only then.
  StreamContent content_of_stream(GstPad* pad) {
    const StreamContent content = content_of(pad);
    const std::lock_guard<std::mutex> lock(mutex_);
    film_.has_track = film_.has_track || content == StreamContent::kHapticTrack;
    film_.has_subtitles = film_.has_subtitles || content == StreamContent::kSubtitles;
    return content;
  }

  GstElement* select_stream(GstPad* pad) {
    if (content_of_stream(pad) != StreamContent::kVideo) return nullptr;
    const Ref<GstCaps> caps(caps_of(pad));
    const std::lock_guard<std::mutex> lock(mutex_);
    ++streams_;
    // A cover may come before the film.
    if (sink_ && (!is_cover_ || is_picture(caps.get()))) return nullptr;
    is_cover_ = is_picture(caps.get());
    film_.packets.clear();
    times_ns_.clear();
    last_ns_ = last_length_ns_ = 0;
    bytes_ = 0;
    sink_ = file_.add_fakesink();
    framing_ = framing_of(caps.get());
    g_object_set(sink_, "signal-handoffs", TRUE, nullptr);
    g_signal_connect(sink_, "handoff", G_CALLBACK(on_packet), this);
    return sink_;
  }

  static void on_packet(GstElement* sink, GstBuffer* packet, GstPad* pad, gpointer user) {
    static_cast<FilmReader*>(user)->add_packet(sink, packet, pad);
  }

  void add_packet(GstElement* sink, GstBuffer* packet, GstPad* pad) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (part_ == Part::kNone || sink != sink_) return;
    const GstClockTime time = stream_time_of(pad, packet);
    if (GST_CLOCK_TIME_IS_VALID(time)) add_time(static_cast<int64_t>(time), packet);
    bytes_ += gst_buffer_get_size(packet);
    if (part_ == Part::kStart) add_hash(packet, GST_CLOCK_TIME_IS_VALID(time) ? time : 0);
    const bool enough = part_ == Part::kStart
                            ? film_.packets.size() >= kStartPackets || bytes_ > kStartBytes
                            : bytes_ > kEndBytes;
    if (!enough) return;
    part_ = Part::kNone;
    gst_element_post_message(
        sink_, gst_message_new_application(GST_OBJECT(sink_), gst_structure_new_empty("enough")));
  }

  void add_hash(GstBuffer* packet, GstClockTime time) {
    GstMapInfo map;
    if (!gst_buffer_map(packet, &map, GST_MAP_READ)) return;
    film_.packets.push_back(
        {hash_packet(map.data, map.size, framing_), map.size, static_cast<int64_t>(time)});
    gst_buffer_unmap(packet, &map);
  }

  void add_time(int64_t time_ns, GstBuffer* packet) {
    if (part_ == Part::kStart) times_ns_.push_back(time_ns);
    if (time_ns < last_ns_) return;
    last_ns_ = time_ns;
    const bool has_length = GST_BUFFER_DURATION_IS_VALID(packet);
    last_length_ns_ = has_length ? static_cast<int64_t>(GST_BUFFER_DURATION(packet)) : 0;
  }

  FilePipeline file_;
  GstElement* const parser_;
  GstElement* sink_ = nullptr;  ///< for the pictures
  int streams_ = 0;             ///< of pictures
  bool is_cover_ = false;       ///< the pictures may be a single one, beside those of the film
  PacketFraming framing_;
  std::mutex mutex_;
  Part part_ = Part::kStart;
  size_t bytes_ = 0;  ///< of this part
  std::vector<int64_t> times_ns_;
  int64_t last_ns_ = 0, last_length_ns_ = 0;
  Film film_;
  std::string missing_;  ///< why there are no pictures
};

}  // namespace

Film read_film(const std::string& path, const std::atomic<bool>* stopped) {
  FilmReader reader(path, stopped);
  return reader.read();
}

}  // namespace spidar
