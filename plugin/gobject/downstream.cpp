// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/gobject/downstream.h"

namespace spidar {
namespace {

class Search {
 public:
  explicit Search(const std::function<bool(GstElement*)>& wanted) : wanted_(wanted) {}

  /// Whether `from` leads to the wanted element: downstream from a source pad, upstream from a sink
  /// pad.
  bool reaches(GstPad* from) {
    Ref<GstPad> own_peer(--pads_left_ > 0 ? gst_pad_get_peer(from) : nullptr);
    if (!own_peer) return false;
    GstPad* const peer = own_peer.get();
    path.push_back({new_ref(from), nullptr});
    // A ghost pad continues inside the bin, and a pad inside a ghost pad has no parent element.
    Ref<GstElement> own_element(gst_pad_get_parent_element(peer));
    GstElement* const element = own_element.get();
    path.push_back({std::move(own_peer), std::move(own_element)});
    if ((element && wanted_(element)) || is_passed_to(peer)) return true;
    path.resize(path.size() - 2);
    return false;
  }

  std::vector<DownstreamStep> path;

 private:
  bool is_passed_to(GstPad* pad) {
    g_autoptr(GstIterator) links = gst_pad_iterate_internal_links(pad);
    if (!links) return false;
    bool reached = false;
    g_auto(GValue) link = G_VALUE_INIT;
    while (!reached && gst_iterator_next(links, &link) == GST_ITERATOR_OK) {
      reached = reaches(GST_PAD(g_value_get_object(&link)));
      g_value_reset(&link);
    }
    return reached;
  }

  const std::function<bool(GstElement*)>& wanted_;
  int pads_left_ = 256;  ///< ends the search in a cycle
};

}  // namespace

std::vector<DownstreamStep> find_path_downstream(GstPad* source,
                                                 const std::function<bool(GstElement*)>& wanted) {
  Search search(wanted);
  search.reaches(source);
  return std::move(search.path);
}

std::vector<DownstreamStep> find_path_downstream(GstElement* element,
                                                 const std::function<bool(GstElement*)>& wanted) {
  const Ref<GstPad> source(gst_element_get_static_pad(element, "src"));
  return source ? find_path_downstream(source.get(), wanted) : std::vector<DownstreamStep>();
}

bool is_upstream(GstPad* sink, const std::function<bool(GstElement*)>& wanted) {
  return Search(wanted).reaches(sink);
}

GstState state_of(GstElement* element) {
  GST_OBJECT_LOCK(element);
  const GstState pending = GST_STATE_PENDING(element);
  const GstState state = pending == GST_STATE_VOID_PENDING ? GST_STATE(element) : pending;
  GST_OBJECT_UNLOCK(element);
  return state;
}

void follow_state(GstElement* bin, GstElement* element) {
  GstState state;
  do {
    state = state_of(bin);
    gst_element_set_state(element, state);
  } while (state != state_of(bin));
}

}  // namespace spidar
