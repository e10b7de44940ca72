// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>

#include "plugin/gobject/ref.h"
#include "plugin/tracks/file_pipeline.h"

namespace spidar {
namespace {

uint64_t big_endian(const std::string& bytes, size_t at, size_t count) {
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
  return value;
}

uint64_t little_endian(std::string bytes, size_t at, size_t count) {
  std::reverse(bytes.begin() + static_cast<int>(at), bytes.begin() + static_cast<int>(at + count));
  return big_endian(bytes, at, count);
}

class FilmFile {
 public:
  explicit FilmFile(const std::string& path)
      : stream_(path, std::ios::binary | std::ios::ate),
        size_(stream_ ? static_cast<uint64_t>(stream_.tellg()) : 0) {}

  FilmEnd end() {
    const std::string head = read(0, 12);
    if (head.compare(0, 4, "RIFF") == 0 && head.compare(8, 4, "AVI ") == 0) return end_of_chunks();
    if (head.compare(0, 4, "OggS") == 0) return last_page();
    if (head.size() == 12 && head.compare(4, 4, "ftyp") == 0) return end_of_boxes();
    if (head.compare(0, 4, "\x1a\x45\xdf\xa3") == 0) return end_of_segment();
    return FilmEnd::kUnknown;
  }

 private:
  /// Fewer bytes at the end of the file.
  std::string read(uint64_t at, size_t count) {
    std::string bytes(count, '\0');
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(&bytes[0], static_cast<std::streamsize>(count));
    bytes.resize(static_cast<size_t>(stream_.gcount()));
    return bytes;
  }

  /// An AVI of more than 1 GB consists of several chunks.
  FilmEnd end_of_chunks() {
    for (uint64_t at = 0; at < size_;) {
      const std::string head = read(at, 8);
      if (head.size() < 8 || head.compare(0, 4, "RIFF") != 0)
        return FilmEnd::kWhole;  // after the film
      const uint64_t length = little_endian(head, 4, 4);
      if (length == 0 || length >= 0x7fffffff) return FilmEnd::kUnknown;
      if (length > size_ - at - 8) return FilmEnd::kCutOff;
      at += 8 + length + length % 2;
    }
    return FilmEnd::kWhole;
  }

  /// ISO/IEC 14496-12.
  FilmEnd end_of_boxes() {
    for (uint64_t at = 0; at < size_;) {
      const std::string head = read(at, 16);
      if (head.size() < 8) return FilmEnd::kCutOff;
      uint64_t length = big_endian(head, 0, 4);
      if (length == 1 && head.size() == 16) length = big_endian(head, 8, 8);
      if (length < 8) return FilmEnd::kUnknown;  // 0: it goes on to the end
      if (length > size_ - at) return FilmEnd::kCutOff;
      at += length;
    }
    return FilmEnd::kWhole;
  }

  /// The end of the EBML element (RFC 8794) that begins at `at` with an identifier of four bytes; 0
  /// when its writer did not know it.
  uint64_t end_of_element(uint64_t at) {
    const std::string head = read(at, 12);
    if (head.size() < 12) return 0;
    const auto first = static_cast<uint8_t>(head[4]);
    size_t length = 1;
    while (length <= 8 && !(first & 0x80u >> (length - 1))) ++length;
    if (length > 8) return 0;
    const uint64_t unknown = (uint64_t{1} << 7 * length) - 1;
    const uint64_t size = big_endian(head, 4, length) & unknown;
    return size == unknown ? 0 : at + 4 + length + size;
  }

  /// Matroska and WebM: a header, then the segment.
  FilmEnd end_of_segment() {
    const uint64_t segment = end_of_element(0);
    const uint64_t end = segment > 0 ? end_of_element(segment) : 0;
    if (end == 0) return FilmEnd::kUnknown;
    return end > size_ ? FilmEnd::kCutOff : FilmEnd::kWhole;
  }

  /// The last page of an Ogg ends a stream, and the file (RFC 3533).
  FilmEnd last_page() {
    constexpr size_t kHead = 27, kLongestPage = 65307;
    constexpr uint8_t kEndOfStream = 4;
    const uint64_t from = size_ > kLongestPage ? size_ - kLongestPage : 0;
    const std::string tail = read(from, kLongestPage);
    const size_t page = tail.rfind("OggS");
    if (page == std::string::npos || tail.size() - page < kHead) return FilmEnd::kCutOff;
    const size_t segments = static_cast<uint8_t>(tail[page + kHead - 1]);
    size_t end = page + kHead + segments;
    for (size_t i = 0; i < segments && page + kHead + i < tail.size(); ++i) {
      end += static_cast<uint8_t>(tail[page + kHead + i]);
    }
    const bool is_last = static_cast<uint8_t>(tail[page + 5]) & kEndOfStream;
    return end > tail.size() || !is_last ? FilmEnd::kCutOff : FilmEnd::kWhole;
  }

  std::ifstream stream_;
  const uint64_t size_;
};

constexpr auto kFlow =
    static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM);

/// "H.265 (Main Profile) decoder", if that is what is missing, and it is for pictures.
std::string missing_decoder(const GstStructure* message) {
  const GstCaps* caps = nullptr;
  const GValue* const detail = gst_structure_get_value(message, "detail");
  if (detail && GST_VALUE_HOLDS_CAPS(detail)) caps = gst_value_get_caps(detail);
  const char* const name = gst_structure_get_string(message, "name");
  return caps && name && kind_of(caps) == StreamKind::kVideo ? name : "";
}

}  // namespace

FilmEnd film_end(const std::string& path) {
  return FilmFile(path).end();
}

void FilmWatch::begin(GstElement* pipeline) {
  GstBus* bus = gst_element_get_bus(pipeline);
  gst_bus_set_sync_handler(bus, hears, this, nullptr);
  gst_object_unref(bus);
  GstElement* decoder = gst_bin_get_by_name(GST_BIN(pipeline), "decode");
  g_signal_connect(decoder, "no-more-pads", G_CALLBACK(choose), this);
  gst_object_unref(decoder);
  convert_ = gst_bin_get_by_name(GST_BIN(pipeline), "convert");
  gst_object_unref(convert_);  // the pipeline has it
}

GstBusSyncReply FilmWatch::hears(GstBus*, GstMessage* message, gpointer user) {
  auto& self = *static_cast<FilmWatch*>(user);
  const std::lock_guard<std::mutex> lock(self.lock_);
  const GstStructure* const about = gst_message_get_structure(message);
  if (about && gst_structure_has_name(about, "spidar-motion")) {
    const char* const reason = gst_structure_get_string(about, "limit-reason");
    ++self.reasons_[reason ? reason : ""];
    gst_message_unref(message);
    return GST_BUS_DROP;
  }
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) self.failed_ = true;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING && !self.failed_) {
    GError* warning = nullptr;
    gst_message_parse_warning(message, &warning, nullptr);
    // Players play what spidarmotion warns of: two frames of the same time, for example.
    const bool is_remark =
        g_strcmp0(G_OBJECT_TYPE_NAME(GST_MESSAGE_SRC(message)), "GstSpidarMotion") == 0;
    std::string& kept = is_remark ? self.remark_ : self.warning_;
    if (kept.empty()) kept = warning->message;
    g_error_free(warning);
  } else if (about && gst_structure_has_name(about, "missing-plugin") && self.missing_.empty()) {
    self.missing_ = missing_decoder(about);
  }
  return GST_BUS_PASS;
}

GstPadProbeReturn FilmWatch::decoded(GstPad*, GstPadProbeInfo* info, gpointer user) {
  if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
    // matroskademux sends gaps while the sound goes on after the pictures; they overtake the last
    // frames, which are still in the decoder.
    const bool is_gap = GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_GAP;
    return is_gap ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
  }
  auto& self = *static_cast<FilmWatch*>(user);
  const std::lock_guard<std::mutex> lock(self.lock_);
  ++self.frames_;
  return GST_PAD_PROBE_OK;
}

/// All streams are known. playbin and playbin3 play the first video, even if another one is marked
/// as default.
void FilmWatch::choose(GstElement* decoder, gpointer user) {
  auto& self = *static_cast<FilmWatch*>(user);
  const Ref<GstPad> into(gst_element_get_static_pad(self.convert_, "sink"));
  if (gst_pad_is_linked(into.get())) return;
  GstPad* chosen = nullptr;
  for (GList* i = decoder->srcpads; i && !chosen; i = i->next) {
    auto* const pad = static_cast<GstPad*>(i->data);
    const Ref<GstCaps> caps(caps_of(pad));
    if (kind_of(caps.get()) == StreamKind::kVideo) chosen = pad;
  }
  if (chosen) gst_pad_add_probe(chosen, kFlow, decoded, user, nullptr);
  if (chosen && gst_pad_link(chosen, into.get()) == GST_PAD_LINK_OK) return;
  {
    const std::string why = why_missing(decoder);
    const std::lock_guard<std::mutex> lock(self.lock_);
    self.has_video_ = false;
    self.why_no_video_ = why;
  }
  GST_ELEMENT_ERROR(decoder, STREAM, WRONG_TYPE, ("There is no video in it."), (nullptr));
}

std::string FilmWatch::problem(const std::string& error) const {
  const std::lock_guard<std::mutex> lock(lock_);
  if (!has_video_) {
    return missing_.empty() ? "there is no video in it" + why_no_video_
                            : "its video cannot be decoded: install a " + missing_;
  }
  // What an element warned of comes before what follows from it: "Internal data stream error".
  if (!warning_.empty()) return warning_;
  if (error.rfind("Internal data stream error", 0) == 0) {
    return "it cannot be read to its end: it is damaged or cut off";
  }
  if (!error.empty()) return error;
  if (frames_ == 0) return "no picture of it can be decoded: it is damaged or cut off";
  return frames_ < 2 ? "it is a single picture, in which nothing moves" : "";
}

std::string FilmWatch::felt() const {
  const std::lock_guard<std::mutex> lock(lock_);
  int frames = 0, felt = 0, most = 0;
  std::string reason;
  for (const auto& [sentence, count] : reasons_) {
    frames += count;
    if (sentence.empty()) felt = count;
    if (sentence.empty() || count <= most) continue;
    most = count;
    reason = sentence;
  }
  if (frames == 0) return {};
  const auto percent = [frames](int count) {
    return std::to_string(std::lround(100.0 * count / frames)) + " %";
  };
  return percent(felt) + " of its frames are felt" +
         (reason.empty() ? "" : "; " + percent(most) + ": " + reason);
}

}  // namespace spidar
