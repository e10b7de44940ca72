// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidar-feel: plays a film, or runs a player, so that the video is felt.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <unistd.h>
#include <vector>

#include <gst/gst.h>

#include "plugin/feel/follow/felt_element.h"
#include "plugin/feel/follow/follow.h"
#include "plugin/feel/playlist.h"
#include "plugin/feel/screen/screen.h"
#include "plugin/feel/tracer/feel_bin.h"
#include "plugin/gobject/ref.h"
#include "plugin/programs/own_plugins.h"
#include "plugin/programs/software_gl.h"
#include "plugin/programs/typed_property.h"
#include "spidar/realtime/standard_descriptors.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "spidar/tools/command_line.h"

namespace {

namespace fs = std::filesystem;

using spidar::tools::kWrongUsage;
using spidar::tools::status_after_printing;

constexpr int kCannotRun = 126;
constexpr int kNoProgram = 127;

constexpr const char* kHelp =
    R"(usage: spidar-feel [PROPERTY=VALUE... --] FILM...
       spidar-feel [PROPERTY=VALUE... --] PROGRAM [ARGUMENT...]
       spidar-feel [PROPERTY=VALUE...] --follow [NAME]
       spidar-feel [PROPERTY=VALUE...] --screen[=WINDOW]
       spidar-feel --properties

Plays FILM, a file or URI, a folder of films or a playlist, or runs PROGRAM, a player that uses GStreamer,
so that the video is felt on what is plugged in: a SPIDAR, a force-feedback joystick, a gamepad. Without a
device, what would be felt is shown. The keys n and b go to the next film and the previous one. PROPERTY is
one of spidarmotion: --properties lists them, and gst-inspect-1.0 spidarmotion explains them. preset=NAME
stands for those of a preset: paper, film or gentle. A haptic track beside FILM, or else its funscripts
(film.funscript, film.roll.funscript and so on) or film.hjif, is felt instead of its motion.

  --follow [NAME]  feel the film that another player plays: VLC, mpv with its package mpv-mpris, or any
                   that tells over the session bus (MPRIS) where it is. NAME is what it is called there;
                   without NAME, the one that plays is followed, and waited for
  --screen         feel the film that the screen shows, in a browser or any other program
  --screen=WINDOW  the same of one window: a part of its title, or ask, for a click on it

  spidar-feel film.mp4
  spidar-feel totem film.mp4
  spidar-feel --follow vlc
  spidar-feel --screen=Firefox
  spidar-feel device=usb profile=spidar-g6c controller=adaptive max-force=2 -- gst-play-1.0 film.mp4
)";

struct Options {
  std::vector<std::string> properties;   ///< NAME=VALUE
  char** program = nullptr;              ///< with its arguments; null: --follow or --screen
  std::string followed;                  ///< name of the player; empty: any
  std::optional<std::string> looked_at;  ///< value of --screen
};

[[noreturn]] void fail(int status, const std::string& what) {
  std::fprintf(stderr, "spidar-feel: %s\n", what.c_str());
  std::exit(status);
}

/// Whether the word is NAME=VALUE, and not a film whose name or URI has an equals sign.
bool is_property(const std::string& word) {
  const size_t end = word.find('=');
  if (end == std::string::npos || word[0] == '-') return false;
  const bool is_name = std::all_of(word.begin(), word.begin() + static_cast<long>(end), [](char c) {
    return g_ascii_isalnum(c) || c == '-' || c == '_';
  });
  std::error_code error;
  return is_name && !fs::exists(word, error);
}

Options parse(int argc, char** argv) {
  Options options;
  int at = 1;
  while (at < argc && is_property(argv[at])) options.properties.emplace_back(argv[at++]);
  const bool separated = at < argc && std::strcmp(argv[at], "--") == 0;
  if (separated) ++at;
  const std::string word = at < argc ? argv[at] : "";
  const std::string next = at + 1 < argc ? argv[at + 1] : "";
  if (word == "--follow") {
    options.followed = next;
    const int wrong = is_property(next) ? at + 1 : at + 2;
    if (wrong >= argc) return options;
    fail(kWrongUsage,
         std::string("--follow takes one NAME, and properties come before it: ") + argv[wrong]);
  }
  if (word == "--screen" || word.rfind("--screen=", 0) == 0) {
    options.looked_at = word.substr(std::min(word.size(), std::strlen("--screen=")));
    if (at + 1 == argc) return options;
    fail(kWrongUsage,
         "--screen is the last word, its window follows '=', and properties come before it: " +
             next);
  }
  if (!options.properties.empty() && !separated) {
    fail(kWrongUsage, "write -- between the properties and the program: spidar-feel " +
                          options.properties.front() + " -- FILM");
  }
  if (at >= argc) fail(kWrongUsage, "no FILM or PROGRAM given; spidar-feel --help tells more");
  if (word[0] == '-' && !fs::exists(word)) {
    fail(kWrongUsage, word + " is not an option; spidar-feel --help tells more");
  }
  options.program = argv + at;
  return options;
}

/// Sets up the environment so that GStreamer finds the plugins.
void find_plugins() {
  gst_init(nullptr, nullptr);
  const std::string missing = spidar::find_own_plugins({"spidar", "spidarfeel"});
  if (!missing.empty()) fail(kCannotRun, missing);
}

spidar::Ref<GstElement> make_motion() {
  auto element = spidar::sunk(gst_element_factory_make("spidarmotion", nullptr));
  if (!element) fail(kCannotRun, "the plugin of gst-spidar cannot be loaded");
  return element;
}

/// Fails, and says what is wrong and what would be right, for an unknown property or preset, a
/// value that a property does not accept, a name of no device, and a profile that cannot be read or
/// does not suit the device. Opens no device, so an unplugged one is no error.
void check(const std::vector<std::string>& properties) {
  const auto element = make_motion();
  try {
    for (const std::string& property : properties) spidar::set_typed(element.get(), property);
    gchar *device_text = nullptr, *profile_text = nullptr;
    g_object_get(element.get(), "device", &device_text, "profile", &profile_text, nullptr);
    const std::string device = spidar::taken(device_text), profile = spidar::taken(profile_text);
    if (device != "none" && device != spidar::kAutoDevice) {
      spidar::make_grip(device, spidar::profile_for(device, profile));
    } else if (!profile.empty()) {
      spidar::load_profile(profile);
    }
  } catch (const std::exception& error) {
    fail(kWrongUsage, error.what());
  }
}

/// Prints NAME={VALUE,…} for each property with a choice of values, else NAME=.
void list_properties() {
  const auto element = make_motion();
  guint count = 0;
  g_autofree GParamSpec** all =
      g_object_class_list_properties(G_OBJECT_GET_CLASS(element.get()), &count);
  for (guint i = 0; i < count; ++i) {
    const GParamSpec* const property = all[i];
    const bool is_own = property->owner_type == G_OBJECT_TYPE(element.get());
    if (!is_own || (property->flags & G_PARAM_WRITABLE) == 0) continue;
    std::string values;
    if (G_IS_PARAM_SPEC_BOOLEAN(property)) values = "true,false";
    if (G_IS_PARAM_SPEC_ENUM(property)) {
      const GEnumClass* const kinds = G_PARAM_SPEC_ENUM(property)->enum_class;
      for (guint k = 0; k < kinds->n_values; ++k) {
        values += (k == 0 ? "" : ",") + std::string(kinds->values[k].value_nick);
      }
    }
    if (!values.empty()) values = "{" + values + "}";
    std::printf("%s=%s\n", property->name, values.c_str());
  }
  g_auto(GStrv) presets = gst_preset_get_preset_names(GST_PRESET(element.get()));
  if (presets) std::printf("preset={%s}\n", spidar::taken(g_strjoinv(",", presets)).c_str());
}

void set_environment(const std::vector<std::string>& properties) {
  std::string lines;
  for (const std::string& property : properties) lines += property + "\n";
  g_setenv(SPIDAR_FEEL_VARIABLE, lines.c_str(), TRUE);
  const char* tracers = g_getenv("GST_TRACERS");
  const std::string all = tracers && *tracers ? std::string(tracers) + ";spidarfeel" : "spidarfeel";
  g_setenv("GST_TRACERS", all.c_str(), TRUE);
}

/// Whether the file begins like a program: as an ELF file, or as text without zero bytes.
bool begins_as_program(const std::string& path) {
  char begin[256] = "";
  std::ifstream file(path, std::ios::binary);
  file.read(begin, sizeof begin);
  const auto size = static_cast<size_t>(file.gcount());
  return std::memcmp(begin, "\177ELF", 4) == 0 || std::memchr(begin, '\0', size) == nullptr;
}

/// Whether `word` is a film and not a program. Some file systems mark every file as executable.
bool is_film(const std::string& word) {
  if (word.find("://") != std::string::npos && gst_uri_is_valid(word.c_str())) return true;
  std::error_code error;
  const bool is_folder = fs::is_directory(word, error);
  if (!is_folder && !fs::is_regular_file(word, error)) return false;
  if (word.find('/') == std::string::npos) {
    if (!spidar::taken(g_find_program_in_path(word.c_str())).empty()) return false;
  }
  return is_folder || spidar::is_playlist(word) || access(word.c_str(), X_OK) != 0 ||
         !begins_as_program(word);
}

/// Plays films with gst-play-1.0.
void run_films(char** films) {
  std::vector<std::string> named;
  for (char** film = films; *film; ++film) {
    if (is_property(*film)) {
      fail(kWrongUsage, std::string("properties come before the film: spidar-feel ") + *film +
                            " -- " + films[0]);
    }
    named.emplace_back(*film);
  }
  try {
    named = spidar::films_of(named);
  } catch (const std::runtime_error& error) {
    fail(kCannotRun, error.what());
  }
  constexpr const char* kPlayer = "gst-play-1.0";
  const bool has_sink = std::any_of(named.begin(), named.end(), [](const std::string& word) {
    return word.rfind("--videosink", 0) == 0;
  });
  // Without a screen, gst-play-1.0 of GStreamer 1.22 ends with SIGSEGV.
  const bool has_screen = spidar::follow::has_display();
  if (!has_sink && !has_screen) {
    std::fputs(
        "spidar-feel: there is no screen for the film: neither WAYLAND_DISPLAY nor DISPLAY is set, "
        "as in a remote session; it is felt without its picture. To write the force to a file "
        "instead: spidar-feel device=none trace=film.csv -- FILM\n",
        stderr);
    named.emplace_back("--videosink=fakesink sync=true");
  }
  const std::string changed = has_sink || !has_screen ? "" : spidar::avoid_software_gl();
  if (!changed.empty()) std::fprintf(stderr, "spidar-feel: %s\n", changed.c_str());
  std::vector<char*> words{const_cast<char*>(kPlayer)};
  for (std::string& film : named) words.push_back(film.data());
  words.push_back(nullptr);
  execvp(kPlayer, words.data());
  const int error = errno;
  if (error == ENOENT) {
    fail(kNoProgram,
         std::string(kPlayer) +
             ", which plays films, is not installed: on Debian and Ubuntu it is in the package "
             "gstreamer1.0-plugins-base-apps; or name another player: spidar-feel totem " +
             films[0]);
  }
  fail(kCannotRun, std::string(kPlayer) + ": " + std::strerror(error));
}

/// Whether the program is a common player that does not use GStreamer.
bool is_without_gstreamer(const std::string& program) {
  constexpr const char* kPrograms[] = {"mpv",  "vlc",     "cvlc",     "mplayer",      "ffplay",
                                       "kodi", "firefox", "chromium", "google-chrome"};
  const std::string name = fs::path(program).filename().string();
  return std::find(std::begin(kPrograms), std::end(kPrograms), name) != std::end(kPrograms);
}

/// Warns when nothing will be felt.
void warn_of_nothing_felt(const Options& options) {
  const char* const device = spidar::follow::value_of(options.properties, "device");
  if (device && std::strcmp(device, "none") == 0) return;  // nothing is to be felt
  if (is_without_gstreamer(options.program[0])) {
    std::fprintf(
        stderr,
        "spidar-feel: %s does not use GStreamer, so nothing of it is felt: follow VLC or mpv with "
        "spidar-feel --follow, feel what the screen shows with spidar-feel --screen, or play the "
        "film with spidar-feel FILM\n",
        options.program[0]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  spidar::open_standard_descriptors();
  spidar::tools::mark_files(argc, argv, false);
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--help" || first == "-h") {
    std::fputs(kHelp, stdout);
    return status_after_printing("spidar-feel", 0);
  }
  if (first == "--version") {
    std::puts("spidar-feel " PACKAGE_VERSION);
    return status_after_printing("spidar-feel", 0);
  }
  if (first == "--properties" && argc == 2) {
    find_plugins();
    list_properties();
    return status_after_printing("spidar-feel", 0);
  }
  Options options = parse(argc, argv);
  const char* const device = spidar::follow::value_of(options.properties, "device");
  if (!device || !*device) {
    options.properties.insert(options.properties.begin(), "device=auto");
  }
  find_plugins();
  check(options.properties);
  if (options.looked_at) return spidar::screen::run(*options.looked_at, options.properties);
  if (!options.program) return spidar::follow::run(options.followed, options.properties);
  set_environment(options.properties);
  if (is_film(options.program[0])) run_films(options.program);
  warn_of_nothing_felt(options);
  execvp(options.program[0], options.program);
  const int error = errno;
  fail(error == ENOENT ? kNoProgram : kCannotRun,
       std::string(options.program[0]) + ": " + std::strerror(error));
}
