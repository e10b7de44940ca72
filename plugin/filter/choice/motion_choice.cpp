// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/choice/motion_choice.h"

#include <stdexcept>

#include "plugin/frame/object_metas.h"
#include "plugin/gobject/bus_messages.h"
#include "plugin/gobject/category.h"
#include "spidar/text.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar::filter {
namespace {

/// A rule that exceeds the film by less than this is not reported.
constexpr gint64 kTolerance_ns = 1'000'000'000;

std::string until(const FeelRule& rule) {
  return rule.to_ns == FeelRule::kNoEnd ? "until the film ends" : "until " + time_text(rule.to_ns);
}

}  // namespace

void MotionChoice::begin_stream(const std::string& film) {
  film_ = film;
  is_read_ = false;
}

void MotionChoice::read(const std::string& feel, GstPad* sink) {
  NamedRules found;
  posted_.clear();
  warned_of_mean_ = false;
  try {
    found = read_feel(feel, film_);
  } catch (const std::runtime_error& error) {
    GST_ELEMENT_WARNING(
        element_, RESOURCE, SETTINGS, ("%s.", error.what()),
        ("The rules are not used; 'motion' says what is felt. The name of a file of rules "
         "ends in .feel."));
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    named_ = std::move(found);
  }
  if (!named_.rules) return;
  GST_INFO_OBJECT(element_, "what is felt: %s", named_.rules->text().c_str());
  warn_of_times(sink);
}

void MotionChoice::warn_of_times(GstPad* sink) {
  gint64 film_ns = 0;
  if (!gst_pad_peer_query_duration(sink, GST_FORMAT_TIME, &film_ns) || film_ns <= 0) return;
  for (const FeelRule& rule : named_.rules->rules()) {
    const bool begins_later = rule.from_ns >= film_ns;
    const bool ends_later = rule.to_ns != FeelRule::kNoEnd && rule.to_ns - film_ns > kTolerance_ns;
    if (!begins_later && !ends_later) continue;
    GST_ELEMENT_WARNING(
        element_, RESOURCE, SETTINGS,
        ("%s, line %d: it %s at %s, but the film ends at %s.", named_.name.c_str(), rule.line,
         begins_later ? "begins" : "ends",
         time_text(begins_later ? rule.from_ns : rule.to_ns).c_str(),
         time_text(film_ns / GST_MSECOND * GST_MSECOND).c_str()),
        ("Times are those of the film, such as 12.5, 0:12 or 1:02:03. A rule that holds up to the "
         "end has none there: 0:12- largest."));
    return;
  }
}

void MotionChoice::warn_of_mean(MotionKind motion) {
  if (motion != MotionKind::kMean || warned_of_mean_) return;
  warned_of_mean_ = true;
  GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                      ("With motion=mean, no objects are known, and %s is not used.",
                       named_.rules ? named_.name.c_str() : "a click"),
                      ("motion=object, objects and camera know them."));
}

void MotionChoice::complete(const GstVideoFrame& frame, const Orientation& turn,
                            FrameSettings& settings) {
  AnalyzerSettings& analyzer = settings.analyzer;
  analyzer.pointer = turn.stored_position(analyzer.pointer);
  // The position of the sink's mouse is already a position in the stored frame.
  if (settings.pointer == Pointer::Kind::kMouse) {
    analyzer.pointer = mouse_.position().value_or(analyzer.pointer);
  }
  analyzer.kept = mouse_.kept();
  analyzer.kept.position = turn.displayed_position(analyzer.kept.position);
  analyzer.feel = named_.rules;
  if (analyzer.feel && analyzer.feel->has_boxes()) {
    analyzer.boxes = boxes_of(frame, settings.touch.packed(), turn);
  }
  if (analyzer.feel || analyzer.kept.click != 0) warn_of_mean(analyzer.motion);
}

std::string MotionChoice::seen_text() const {
  return time_text(static_cast<int64_t>(seen_ / GST_MSECOND * GST_MSECOND));
}

void MotionChoice::warn_of_rule(const FeelRule& rule, Chosen::State state) {
  if (!posted_.emplace(rule.line, state).second) return;
  const std::string position = position_text(rule.position), end = until(rule);
  const char* const name = named_.name.c_str();
  switch (state) {
    case Chosen::State::kNotThere:
      GST_ELEMENT_WARNING(
          element_, STREAM, FAILED,
          ("%s, line %d: no object was at %s at %s.", name, rule.line, position.c_str(),
           time_text(rule.from_ns).c_str()),
          ("An object moves by itself. The first one that begins to move there is felt, %s.",
           end.c_str()));
      break;
    case Chosen::State::kNotSeen:
      GST_ELEMENT_WARNING(
          element_, STREAM, FAILED,
          ("%s, line %d: playback began after %s, so that the object that is at %s then is not "
           "known.",
           name, rule.line, time_text(rule.from_ns).c_str(), position.c_str()),
          ("Nothing is felt %s. In a haptic track, which spidartrack record makes, it is known.",
           end.c_str()));
      break;
    case Chosen::State::kLost:
      GST_ELEMENT_WARNING(
          element_, STREAM, FAILED,
          ("%s, line %d: the object is lost at %s.", name, rule.line, seen_text().c_str()),
          ("It was hidden for too long, or the scene is another. Nothing is felt %s, unless "
           "another rule begins where it is seen again.",
           end.c_str()));
      break;
    case Chosen::State::kNoBox:
      GST_ELEMENT_WARNING(
          element_, STREAM, FAILED,
          ("%s, line %d: no frame comes with a box%s%s.", name, rule.line,
           rule.name[0] ? " called " : "", rule.name.data()),
          ("A detector or tracker before this element attaches boxes to the frames, as "
           "GstVideoRegionOfInterestMeta or GstAnalyticsODMtd. Nothing is felt until one comes, or "
           "%s.",
           end.c_str()));
      break;
    case Chosen::State::kBoxAtRest:
      GST_ELEMENT_WARNING(
          element_, STREAM, FAILED,
          ("%s, line %d: nothing moves in the boxes that come with the frames.", name, rule.line),
          ("A box chooses the object that moves in it. Nothing is felt until one does, or %s.",
           end.c_str()));
      break;
    case Chosen::State::kGood:
      break;
  }
}

void MotionChoice::warn_of_click(const KeptObject& kept, Chosen::State state) {
  if (state == Chosen::State::kGood) return;
  mouse_.release(kept.click);
  const auto inform = [this](const std::string& text, const char* advice) {
    post_information(element_, GST_STREAM_ERROR, GST_STREAM_ERROR_FAILED, text, advice);
  };
  if (state == Chosen::State::kLost) {
    inform("The object that was clicked is lost at " + seen_text() + ".",
           "What 'motion' and 'feel' say is felt again.");
  } else {
    inform(formatted("No object is at %.2f,%.2f, where the mouse was clicked.", kept.position.x(),
                     kept.position.y()),
           "An object moves by itself.");
  }
}

void MotionChoice::check(const Chosen& choice, const KeptObject& kept, GstClockTime stream_time) {
  if (choice.is_kept) {
    warn_of_click(kept, choice.state);
  } else if (choice.rule) {
    warn_of_rule(*choice.rule, choice.state);
  }
  if (GST_CLOCK_TIME_IS_VALID(stream_time)) seen_ = stream_time;
}

}  // namespace spidar::filter
