// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/gnuplot.h"

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <glib.h>

#include "plugin/gobject/ref.h"
#include "spidar/child_process.h"
#include "spidar/realtime/uninterrupted.h"

namespace spidar::tools {
namespace {

[[noreturn]] void fail(int error, const std::string& hint = "") {
  throw std::runtime_error(std::string("gnuplot: ") + std::strerror(error) + hint);
}

/// A file in memory, which needs no folder for temporary files, with the content `text`.
std::unique_ptr<FILE, int (*)(FILE*)> nameless_file(const std::string& text = "") {
  const int descriptor = memfd_create("spidartrack", MFD_CLOEXEC);
  if (descriptor < 0) fail(errno);
  std::unique_ptr<FILE, int (*)(FILE*)> file(fdopen(descriptor, "w+"), std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
      std::fflush(file.get()) != 0) {
    fail(errno);
  }
  std::rewind(file.get());
  return file;
}

/// Returns gnuplot's status, as waitpid() reports it. gnuplot gets no file names, because it runs a
/// name that begins with | or < as a command.
int run(int in, int out, int errors) {
  // The user's ~/.gnuplot does not apply. The signals that this program blocks must end gnuplot.
  const pid_t process = start_child(
      taken(g_find_program_in_path("gnuplot")), {"gnuplot", "--default-settings"},
      {{in, STDIN_FILENO}, {out, STDOUT_FILENO}, {errors, STDERR_FILENO}}, POSIX_SPAWN_SETSIGMASK);
  if (process < 0) fail(errno, "; it is in the Debian package gnuplot-nox");
  int status = 0;
  uninterrupted([&] { return waitpid(process, &status, 0); });
  return status;
}

/// Returns the last line that is not blank, after a colon; empty if there is none.
std::string last_line(FILE* file) {
  std::rewind(file);
  std::string last;
  char line[256];
  while (std::fgets(line, sizeof line, file)) {
    std::string text = line;
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    if (!text.empty()) last = ": " + text;
  }
  return last;
}

/// Whether the file ends as a PNG does. gnuplot reports no error when the disk is full.
bool is_whole_png(int descriptor) {
  constexpr char kEnd[] = "\0\0\0\0IEND\xAE\x42\x60\x82";
  char end[sizeof kEnd - 1] = {};
  const off_t size = lseek(descriptor, 0, SEEK_END);
  return size > static_cast<off_t>(sizeof end) &&
         pread(descriptor, end, sizeof end, size - static_cast<off_t>(sizeof end)) ==
             static_cast<ssize_t>(sizeof end) &&
         std::memcmp(end, kEnd, sizeof end) == 0;
}

}  // namespace

void draw_with_gnuplot(const std::string& script, const PartFile& picture) {
  const auto commands = nameless_file(script);
  // Its warnings, of fonts for example, do not matter if it succeeds.
  const auto warnings = nameless_file();
  if (run(fileno(commands.get()), picture.descriptor(), fileno(warnings.get())) != 0) {
    throw std::runtime_error("gnuplot could not draw the picture" + last_line(warnings.get()));
  }
  if (!is_whole_png(picture.descriptor())) {
    throw std::runtime_error(picture.target() +
                             ": cannot be written as a whole; the disk may be full");
  }
}

std::string gnuplot_string(const std::string& text) {
  // In single quotes there are no escapes: a quote is doubled. A line cannot end within them.
  std::string result = "'";
  for (const char c : text) {
    result += c == '\'' ? std::string("''") : std::string(1, c == '\n' || c == '\0' ? ' ' : c);
  }
  return result + "'";
}

}  // namespace spidar::tools
