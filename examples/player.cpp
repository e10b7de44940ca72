// A player for the terminal: a film, and its motion in the hand.
//
//   player [--headless] FILE-OR-URI
//
// Without a film it says which keys there are. They may also come from a pipe: each is done when
// the one before is.
#include "examples/player/player.h"

#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <unistd.h>

#include <glib-unix.h>

namespace {

constexpr char kKeys[] =
    "space pause, left and right 5 s, up and down a minute, + and - speed, . next frame, l loop,\n"
    "f force on and off, d and a number and return: the force comes so many ms later, q quit\n";

struct Session {
  Player& player;
  std::string name;  ///< of the film
  GMainLoop* loop;
  KeyReader keys;
  bool terminal = isatty(STDOUT_FILENO) != 0;
  int result = 0;
};

void show(const Session& session) {
  const std::string& typed = session.keys.typed();
  std::printf(session.terminal ? "\r\033[K%s %s" : "%s%s\n", session.player.status().c_str(),
              typed.c_str());
  std::fflush(stdout);
}

gboolean on_key(gint file, GIOCondition, gpointer user) {
  auto& session = *static_cast<Session*>(user);
  char byte = 0;
  if (read(file, &byte, 1) != 1) return G_SOURCE_REMOVE;  // no more keys: the film plays on
  const Action action = session.keys.take(byte);
  if (action.command == Command::kQuit) g_main_loop_quit(session.loop);
  session.player.act(action);
  if (session.terminal || action.command != Command::kNone) show(session);
  return G_SOURCE_CONTINUE;
}

gboolean on_time(gpointer user) {
  const auto& session = *static_cast<Session*>(user);
  if (session.terminal) show(session);
  return G_SOURCE_CONTINUE;
}

gboolean on_signal(gpointer user) {
  g_main_loop_quit(static_cast<Session*>(user)->loop);
  return G_SOURCE_CONTINUE;
}

gboolean on_message(GstBus*, GstMessage* message, gpointer user) {
  auto& session = *static_cast<Session*>(user);
  GError* error = nullptr;
  switch (GST_MESSAGE_TYPE(message)) {
    case GST_MESSAGE_EOS:
      if (!session.player.again()) g_main_loop_quit(session.loop);
      break;
    case GST_MESSAGE_WARNING:
      gst_message_parse_warning(message, &error, nullptr);
      std::fprintf(stderr, "\n%s\n", error->message);
      break;
    case GST_MESSAGE_ERROR:
      gst_message_parse_error(message, &error, nullptr);
      std::fprintf(stderr, "\n%s: %s\n", session.name.c_str(), error->message);
      session.result = 1;
      g_main_loop_quit(session.loop);
      break;
    default:
      break;
  }
  g_clear_error(&error);
  return G_SOURCE_CONTINUE;
}

/// Throws std::runtime_error for a file that cannot be a film.
std::string uri_of(const std::string& name) {
  if (gst_uri_is_valid(name.c_str())) return name;
  std::error_code error;
  const auto status = std::filesystem::status(name, error);
  if (!std::filesystem::exists(status)) throw std::runtime_error(name + ": no such file");
  if (std::filesystem::is_directory(status)) {
    throw std::runtime_error(name + ": a folder; name a film in it");
  }
  if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(name, error) == 0) {
    throw std::runtime_error(name + ": an empty file");
  }
  gchar* uri = gst_filename_to_uri(name.c_str(), nullptr);
  const std::string result = uri;
  g_free(uri);
  return result;
}

int run(const std::string& name, bool headless) {
  Player player(uri_of(name), headless);
  const RawTerminal raw(STDIN_FILENO);
  Session session{player, name, g_main_loop_new(nullptr, FALSE), {}};
  gst_bus_add_watch(player.bus(), on_message, &session);
  player.play();
  g_unix_fd_add(STDIN_FILENO, static_cast<GIOCondition>(G_IO_IN | G_IO_HUP), on_key, &session);
  g_unix_signal_add(SIGINT, on_signal, &session);
  g_timeout_add(100, on_time, &session);
  show(session);
  g_main_loop_run(session.loop);
  show(session);
  if (session.terminal) std::printf("\n");
  gst_bus_remove_watch(player.bus());
  g_main_loop_unref(session.loop);
  return session.result;
}

}  // namespace

int main(int argc, char** argv) {
  const bool headless = argc > 2 && std::strcmp(argv[1], "--headless") == 0;
  if (argc != (headless ? 3 : 2) || argv[argc - 1][0] == '-') {
    std::fprintf(stderr, "usage: %s [--headless] FILE-OR-URI\n\n%s", argv[0], kKeys);
    return 2;
  }
  gst_init(nullptr, nullptr);
  try {
    return run(argv[argc - 1], headless);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
