/// What an element's frames go on to.
#pragma once

#include <functional>

#include <gst/gst.h>

namespace spidar {

/// The first element behind `element`, through bins, for which `wanted` says yes, or null. The
/// caller unrefs it. Links that change meanwhile end the search.
GstElement* find_downstream(GstElement* element, const std::function<bool(GstElement*)>& wanted);

}  // namespace spidar
