// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A player for the terminal: plays a film and renders its motion as force.
//
//   player [--headless] FILE-OR-URI
//
// On a terminal it shows the keys, what is playing, and the force as a bar. Keys may also come from
// a pipe; each takes effect when the previous one has.
#include "apps/player/player.h"

#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <unistd.h>
#include <vector>

#include <glib-unix.h>

#include "apps/film/failure.h"
#include "apps/film/film_uri.h"
#include "apps/help.h"
#include "apps/player/raw_terminal.h"
#include "apps/player/status_lines.h"

namespace {

const std::vector<std::string> kKeys = {
    "space pause   left, right 5 s   up, down 1 min   + - speed   . next frame   l loop",
    "f force on, off   d NUMBER return: the force comes so many ms later   q quit"};

struct Session {
  Player& player;
  std::string name;  ///< of the film
  std::string uri;
  GMainLoop* loop;
  StatusLines lines;
  KeyReader keys;
  int result = 0;
};

void show(Session& session) {
  const Player& player = session.player;
  const std::string& typed = session.keys.typed();
  session.lines.show({player.status() + (session.lines.is_terminal() ? "  " + typed : typed),
                      "force " + force_line(player.force_N(), player.max_force_N()), kKeys[0],
                      kKeys[1]});
}

/// Prints a line for the user, below the status lines.
void tell(Session& session, const std::string& text) {
  session.lines.leave();
  std::fprintf(stderr, "%s\n", text.c_str());
}

gboolean on_key(gint file, GIOCondition, gpointer user) {
  auto& session = *static_cast<Session*>(user);
  char byte = 0;
  if (read(file, &byte, 1) != 1) return G_SOURCE_REMOVE;  // end of input: the film continues
  const Action action = session.keys.take(byte);
  if (action.command == Command::kQuit) g_main_loop_quit(session.loop);
  session.player.act(action);
  if (session.lines.is_terminal() || action.command != Command::kNone) show(session);
  return G_SOURCE_CONTINUE;
}

gboolean on_time(gpointer user) {
  auto& session = *static_cast<Session*>(user);
  if (session.lines.is_terminal()) show(session);
  return G_SOURCE_CONTINUE;
}

gboolean on_signal(gpointer user) {
  g_main_loop_quit(static_cast<Session*>(user)->loop);
  return G_SOURCE_CONTINUE;
}

void fail(Session& session, const std::string& reason) {
  tell(session, session.name + ": " + reason);
  session.result = 1;
  g_main_loop_quit(session.loop);
}

void end(Session& session) {
  const std::string early = early_end_text(session.player.pipeline());
  if (!early.empty()) tell(session, session.name + ": " + early);
  if (!session.player.again()) g_main_loop_quit(session.loop);
}

gboolean on_message(GstBus*, GstMessage* message, gpointer user) {
  auto& session = *static_cast<Session*>(user);
  GError* told = nullptr;
  switch (GST_MESSAGE_TYPE(message)) {
    case GST_MESSAGE_ASYNC_DONE:
      if (has_no_video(session.player.pipeline())) fail(session, kNoVideo);
      break;
    case GST_MESSAGE_ELEMENT:
      session.player.note(gst_message_get_structure(message));
      break;
    case GST_MESSAGE_EOS:
      end(session);
      break;
    case GST_MESSAGE_WARNING:
      gst_message_parse_warning(message, &told, nullptr);
      tell(session, told->message);
      g_error_free(told);
      break;
    case GST_MESSAGE_INFO:
      gst_message_parse_info(message, &told, nullptr);
      tell(session, told->message);
      g_error_free(told);
      break;
    case GST_MESSAGE_ERROR:
      fail(session, failure_text(message, session.uri));
      break;
    default:
      break;
  }
  return G_SOURCE_CONTINUE;
}

int run(const std::string& name, bool headless) {
  const std::string uri = film_uri(name);
  Player player(uri, headless);
  if (!headless && !player.why_no_screen().empty()) {
    std::fprintf(stderr, "played without a window: %s\n", player.why_no_screen().c_str());
  }
  const RawTerminal raw(STDIN_FILENO);
  Session session{player, name, uri, g_main_loop_new(nullptr, FALSE), {}, {}};
  gst_bus_add_watch(player.bus(), on_message, &session);
  player.play();
  g_unix_fd_add(STDIN_FILENO, static_cast<GIOCondition>(G_IO_IN | G_IO_HUP), on_key, &session);
  g_unix_signal_add(SIGINT, on_signal, &session);
  g_unix_signal_add(SIGTERM, on_signal, &session);
  g_unix_signal_add(SIGHUP, on_signal, &session);
  g_timeout_add(100, on_time, &session);
  show(session);
  g_main_loop_run(session.loop);
  if (session.result == 0) show(session);
  session.lines.leave();
  gst_bus_remove_watch(player.bus());
  g_main_loop_unref(session.loop);
  return session.result;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string usage = std::string("usage: ") + argv[0] + " [--headless] FILE-OR-URI\n\n" +
                            kKeys[0] + "\n" + kKeys[1] + "\n";
  if (asks_for_help(argc, argv, usage)) return 0;
  const bool headless = argc > 2 && std::strcmp(argv[1], "--headless") == 0;
  if (argc != (headless ? 3 : 2) || argv[argc - 1][0] == '-') {
    std::fputs(usage.c_str(), stderr);
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
