// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/motion_join.h"
#include "plugin/tools/film_analyzer.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/motion_sidecar.h"
#include "plugin/track/part_file.h"
#include "plugin/track/sidecar.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

constexpr const char* kJoinHelp =
    R"(usage: spidartrack join PIECE...

Makes of all pieces of a film what one run would make of it, to the last bit: FILM.haptic.flac of the
pieces of spidartrack record --shard K/N FILM, with their properties and format, FILM.motion of those
of spidartrack analyze --shard K/N FILM. A file of this name is replaced. The pieces stay.

  for k in 1 2 3; do spidartrack record --shard $k/3 film.mp4 & done; wait
  spidartrack join film.mp4.*of3.motion
)";

using NamedPiece = std::pair<std::string, MotionHeader>;

[[noreturn]] void fail(const std::string& file, const std::exception& error) {
  throw std::runtime_error(file + ": " + error.what());
}

/// By number.
std::vector<NamedPiece> list_pieces(const std::vector<std::string>& files) {
  std::vector<NamedPiece> pieces;
  for (const std::string& file : files) {
    try {
      pieces.emplace_back(file, read_motion_header(file));
    } catch (const std::runtime_error& error) {
      fail(file, error);
    }
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const NamedPiece& a, const NamedPiece& b) {
    return a.second.piece.number < b.second.piece.number;
  });
  for (size_t i = 1; i < pieces.size(); ++i) {
    if (pieces[i].second.piece.number != pieces[i - 1].second.piece.number) continue;
    throw UsageError(pieces[i - 1].first + " and " + pieces[i].first + ": they are the same piece");
  }
  return pieces;
}

/// The file of a film that all pieces are of, by the name of one of them.
std::string film_of(const NamedPiece& piece) {
  const std::string end = motion_end(piece.second.piece);
  if (ends_with(piece.first, end)) return piece.first.substr(0, piece.first.size() - end.size());
  throw UsageError(piece.first + ": the name of the film is not known; the file was called FILM" +
                   end);
}

std::string joined(const std::vector<NamedPiece>& pieces, const std::string& film) {
  MotionJoin join;
  for (const auto& [file, header] : pieces) {
    try {
      join.add(read_motion_file(file));
    } catch (const std::runtime_error& error) {
      fail(file, error);
    }
  }
  try {
    return join.whole();
  } catch (const std::runtime_error& error) {
    fail(film, error);
  }
}

void save_bytes(const std::string& bytes, const PartFile& part) {
  std::ofstream file(part.path(), std::ios::binary);
  file << bytes;
  file.close();
  if (!file) throw std::runtime_error(part.target() + ": cannot be written; the disk may be full");
}

}  // namespace

int join_pieces_command(int argc, char** argv) {
  bool help = false;
  const std::vector<std::string> files =
      parse_options(argc, argv, {{"help", false, [&](const std::string&) { help = true; }}});
  if (help) {
    std::cout << kJoinHelp;
    return kDone;
  }
  if (files.empty()) throw UsageError("no PIECE given");
  const std::vector<NamedPiece> pieces = list_pieces(files);
  const std::string film = film_of(pieces.front());
  const std::string bytes = joined(pieces, film);
  const std::string& format = pieces.front().second.piece.format;
  const std::string target = film + (format.empty() ? kMotionEnd : ".haptic." + format);
  PartFile part(target);
  if (format.empty()) {
    save_bytes(bytes, part);
  } else {
    const PartFile motion(target + kMotionEnd);
    save_bytes(bytes, motion);
    render_analysis(motion.path(), part.path(), {});
  }
  part.publish();
  const std::string why = format.empty() ? std::string() : why_not_played(film, target);
  if (!why.empty()) std::cerr << "spidartrack: " << why << '\n';
  std::cout << target << '\n';
  return kDone;
}

}  // namespace spidar
