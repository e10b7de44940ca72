// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/player/raw_terminal.h"

#include <csignal>
#include <termios.h>
#include <unistd.h>

namespace {

constexpr int kDeadly[] = {SIGHUP,  SIGINT, SIGQUIT, SIGTERM, SIGABRT,
                           SIGSEGV, SIGBUS, SIGFPE,  SIGILL};

// State of the process, like its signal handlers. Written before they are installed.
int terminal = -1;
termios before, raw;

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

/// Does what the signal would do without a handler.
void raise_plainly(int signal) {
  handle(signal, SIG_DFL);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal);
  raise(signal);
  sigprocmask(SIG_UNBLOCK, &only, nullptr);
}

// Both call only functions that are safe in a signal handler.
void restore_and_die(int signal) {
  tcsetattr(terminal, TCSANOW, &before);
  raise_plainly(signal);
}

void restore_and_stop(int signal) {
  tcsetattr(terminal, TCSANOW, &before);
  raise_plainly(signal);
  // The process has been continued.
  handle(signal, restore_and_stop);
  tcsetattr(terminal, TCSANOW, &raw);
}

}  // namespace

RawTerminal::RawTerminal(int file) {
  if (isatty(file) == 0 || tcgetattr(file, &before) != 0) return;
  terminal = file;
  raw = before;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  for (const int signal : kDeadly) handle(signal, restore_and_die);
  handle(SIGTSTP, restore_and_stop);
  tcsetattr(terminal, TCSANOW, &raw);
}

RawTerminal::~RawTerminal() {
  if (terminal < 0) return;
  tcsetattr(terminal, TCSANOW, &before);
  for (const int signal : kDeadly) handle(signal, SIG_DFL);
  handle(SIGTSTP, SIG_DFL);
  terminal = -1;
}
