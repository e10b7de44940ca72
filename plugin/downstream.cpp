#include "plugin/downstream.h"

namespace spidar {
namespace {

class Search {
 public:
  explicit Search(const std::function<bool(GstElement*)>& wanted) : wanted_(wanted) {}

  GstElement* behind(GstPad* source) {
    GstPad* peer = --pads_left_ > 0 ? gst_pad_get_peer(source) : nullptr;
    if (!peer) return nullptr;
    // Of a ghost pad the links go on inside, and what is inside of one has no parent element.
    GstElement* element = gst_pad_get_parent_element(peer);
    GstElement* found = element && wanted_(element) ? element : nullptr;
    if (element && !found) gst_object_unref(element);
    GstIterator* links = found ? nullptr : gst_pad_iterate_internal_links(peer);
    gst_object_unref(peer);
    if (!links) return found;
    GValue link = G_VALUE_INIT;
    while (!found && gst_iterator_next(links, &link) == GST_ITERATOR_OK) {
      found = behind(GST_PAD(g_value_get_object(&link)));
      g_value_reset(&link);
    }
    g_value_unset(&link);
    gst_iterator_free(links);
    return found;
  }

 private:
  const std::function<bool(GstElement*)>& wanted_;
  int pads_left_ = 256;  // ends a search that goes round in a circle
};

}  // namespace

GstElement* find_downstream(GstElement* element, const std::function<bool(GstElement*)>& wanted) {
  GstPad* source = gst_element_get_static_pad(element, "src");
  if (!source) return nullptr;
  GstElement* found = Search(wanted).behind(source);
  gst_object_unref(source);
  return found;
}

}  // namespace spidar
