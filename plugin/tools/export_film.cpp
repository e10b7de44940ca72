// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <glib.h>

#include "plugin/tools/film_page.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

/// As both are named, without following links: a browser does not follow them either.
std::string relative_url(const fs::path& film, const fs::path& page) {
  const fs::path folder = fs::absolute(page).lexically_normal().parent_path();
  const fs::path path = fs::absolute(film).lexically_normal().lexically_relative(folder);
  gchar* const escaped = g_uri_escape_string(path.c_str(), "/", FALSE);
  const std::string url = escaped;
  g_free(escaped);
  return url;
}

}  // namespace

int export_film(const ExportOptions& options) {
  const std::string &film = options.film, &to = options.to;
  if (!ends_with(to, ".html")) throw UsageError(to + ": is to end in .html");
  PartFile part(to, {options.force, "spidartrack export"});
  FilmPage page;
  const TrackCondition condition =
      read_track(film, [&page](const TrackSample& sample) { page.add(sample); });
  if (condition.film.empty()) {
    throw UsageError(film + ": is a track; give the film that it is for");
  }
  expect_own_track(condition);
  const FilmPage::Html html = page.html(relative_url(film, to), fs::path(film).filename(),
                                        1e-9 * static_cast<double>(condition.later_ns));
  part.write(html.text);
  publish(part);
  std::printf("%s: %s; %zu KB, exact to %.2f N\n", film.c_str(), to.c_str(),
              html.text.size() / 1000, html.tolerance_N);
  return kDone;
}

}  // namespace spidar
