// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A pipeline that reads a file from a thread that can be stopped, and what is in its streams.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <gst/gst.h>

namespace spidar {

class FilePipeline {
 public:
  static constexpr GstClockTime kLongestSilence = 10 * GST_SECOND;

  /// `line` contains a filesrc named "source". Throws std::runtime_error when `path` is not a
  /// regular file, because reading anything else may wait for ever, or when an element is missing.
  FilePipeline(const std::string& line, const std::string& path,
               const std::atomic<bool>* stopped = nullptr,
               GstClockTime longest_silence = kLongestSilence);
  FilePipeline(const FilePipeline&) = delete;
  FilePipeline& operator=(const FilePipeline&) = delete;

  GstElement* pipeline() const { return pipeline_.get(); }
  /// Owned by the pipeline.
  GstElement* find(const char* name) const;
  /// Adds a sink that discards what it gets as fast as it comes. Owned by the pipeline.
  GstElement* add_fakesink() const;

  /// Of a parsebin "parse": links each stream when it begins to flow, to the element that `take`
  /// returns, or to a sink that discards it if that is null. A stream may be found while others
  /// flow; linked only now, its parser leaves the data as they are in the file. Streaming threads.
  using Take = std::function<GstElement*(GstPad*)>;
  void link_streams(Take take);
  /// Plays until a message of `awaited` or EOS comes, and returns which; GST_MESSAGE_UNKNOWN when
  /// `limit` has passed. Throws std::runtime_error with the text of an error, when nothing was
  /// read for `longest_silence`, because some demuxers stop at damage without an error, or when
  /// `*stopped` has become true.
  GstMessageType play_until(GstMessageType awaited, GstClockTime limit = GST_CLOCK_TIME_NONE) const;
  /// Calls `take` with the text of each error, in the thread of what reports it. Before
  /// play_until().
  void hear_errors(std::function<void(const std::string&)> take);
  /// How a thread that waits for what is read remembers what it has seen.
  struct Progress {
    uint64_t read = 0;
    GstClockTime silent = 0;
  };
  /// How often such a thread looks whether it is to stop.
  static constexpr GstClockTime kLook = 20 * GST_MSECOND;
  /// To be called once in kLook. Throws std::runtime_error as play_until() does when nothing comes.
  void check(Progress& progress) const;
  /// Holds the streams where they are, until play_until(), and forgets messages that have come: an
  /// EOS that follows a seek is then that of the seek.
  void pause() const;
  /// No callback runs any more.
  void stop() const { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

 private:
  using Bus = std::unique_ptr<GstBus, void (*)(gpointer)>;
  Bus bus() const { return {gst_element_get_bus(pipeline_.get()), gst_object_unref}; }

  static GstBusSyncReply handle(GstBus* bus, GstMessage* message, gpointer self);
  static GstPadProbeReturn link(GstPad* pad, GstPadProbeInfo* info, gpointer self);

  const std::atomic<bool>* const stopped_;
  const GstClockTime longest_silence_;
  std::atomic<uint64_t> read_{0};
  Take take_;
  std::function<void(const std::string&)> take_error_;
  std::unique_ptr<GstElement, void (*)(GstElement*)> pipeline_;
};

/// "1.250 s".
std::string seconds_text(int64_t ns);

/// A line of the comment of a track, which FLAC, Matroska and WAV keep, and a tag of its own where
/// there are such. Whatever writes tracks writes it.
extern const char* const kTrackMark;

/// Whether tags of a stream contain the mark. Those of a container apply to all of its streams, and
/// say nothing of one of them.
bool is_marked_track(const GstTagList* tags);

/// Whether the stream that comes to a pad is marked, from the events that come to it.
class TrackMark {
 public:
  void follow(GstEvent* event);
  bool is_set() const { return is_set_; }

 private:
  // When the first packets of a network stream are lost, its tags may come before its start, after
  // one that rtpgstdepay has made up. Such a stream has no caps.
  bool has_caps_ = false;
  bool is_set_ = false;
};

/// Whether a tag that has come to `pad` is marked.
bool is_marked_track(GstPad* pad);

/// Whether sound that nothing has converted, such as that in a file, has the form of the tracks
/// that this project writes: six channels of 1000 samples a second, which no sound for ears has.
bool has_form_of_track(const GstCaps* caps);

/// How to mark a file, as the rest of a sentence.
std::string how_to_mark();

enum class StreamContent {
  kVideo,
  kSound,        ///< for ears
  kHapticTrack,  ///< has_form_of_track(), or is_marked_track()
  kOther,
};

/// Of the caps of a parsed or decoded stream.
StreamContent content_of(const GstCaps* caps);
/// Of the stream at a pad, by its caps and by the tags that have come to it.
StreamContent content_of(GstPad* pad);

/// Whether a stream is of pictures that are files otherwise, as a cover is: image/jpeg, image/png.
bool is_picture(const GstCaps* caps);

/// Why no pictures, or no sound, come from the demuxers in `bin`, as the rest of a sentence; empty
/// unless there is a known reason.
std::string why_missing(GstElement* bin);

/// Stream time of a buffer that passes the pad; GST_CLOCK_TIME_NONE when it has none.
GstClockTime stream_time_of(GstPad* pad, GstBuffer* buffer);

/// Current caps, else what the pad could have. Owned by the caller.
GstCaps* caps_of(GstPad* pad);

}  // namespace spidar
