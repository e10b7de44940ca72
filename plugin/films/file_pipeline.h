// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
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

  /// A pipeline that reads a file from a thread that can be stopped. `line` contains a filesrc
  /// named "source". Throws std::runtime_error when `path` is not a regular file, because reading
  /// anything else may wait for ever, or when an element is missing.
  FilePipeline(const std::string& line, const std::string& path,
               const std::atomic<bool>* stopped = nullptr,
               GstClockTime longest_silence = kLongestSilence);
  FilePipeline(const FilePipeline&) = delete;
  FilePipeline& operator=(const FilePipeline&) = delete;

  GstElement* pipeline() const { return pipeline_.get(); }
  GstElement* find(const char* name) const;
  /// Adds a sink that discards data as fast as they come. Owned by the pipeline.
  GstElement* add_fakesink() const;

  /// Links each stream of a parsebin "parse" when it begins to flow, to the element that `take`
  /// returns, or to a sink that discards it if that is null. A stream may be found while others
  /// flow; linked only now, its parser leaves the data as they are in the file. Streaming threads.
  void link_streams(std::function<GstElement*(GstPad*)> take);
  /// Plays until a message of `awaited` or EOS comes, and returns which; GST_MESSAGE_UNKNOWN when
  /// `limit` has passed. Throws std::runtime_error with the text of an error, when nothing was read
  /// for `longest_silence`, because some demuxers stop at damage without an error, or when
  /// `*stopped` has become true.
  GstMessageType play_until(GstMessageType awaited, GstClockTime limit = GST_CLOCK_TIME_NONE) const;
  /// Calls `take` with each error's text, in the thread that reports it. Call this before
  /// play_until().
  void on_error(std::function<void(const std::string&)> take);
  /// The state of a thread that waits for data, between two calls of check().
  struct Progress {
    uint64_t read = 0;
    GstClockTime silent = 0;
  };
  /// The period in which such a thread checks whether it must stop.
  static constexpr GstClockTime kLook = 20 * GST_MSECOND;
  /// Call this once in kLook. Throws std::runtime_error as play_until() does when nothing comes.
  void check(Progress& progress) const;
  /// Pauses the streams until play_until(), and discards earlier messages, so that an EOS after a
  /// seek belongs to that seek.
  void pause() const;
  void stop() const { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

 private:
  std::unique_ptr<GstBus, void (*)(gpointer)> bus() const {
    return {gst_element_get_bus(pipeline_.get()), gst_object_unref};
  }

  static GstBusSyncReply handle(GstBus* bus, GstMessage* message, gpointer self);
  static GstPadProbeReturn link(GstPad* pad, GstPadProbeInfo* info, gpointer self);

  const std::atomic<bool>* const stopped_;
  const GstClockTime longest_silence_;
  std::atomic<uint64_t> read_{0};
  std::function<GstElement*(GstPad*)> take_;
  std::function<void(const std::string&)> take_error_;
  std::unique_ptr<GstElement, void (*)(GstElement*)> pipeline_;
};

/// Seeks to the key frame before `time_ns`. Returns whether that succeeds.
bool seek_before(GstElement* sink, int64_t time_ns);

std::string seconds_text(int64_t ns);

}  // namespace spidar
