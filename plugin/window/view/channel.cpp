// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/view/channel.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "plugin/window/view/messages.h"
#include "spidar/realtime/uninterrupted.h"

namespace spidar::window {
namespace {

struct Header {
  uint32_t magic = 0x53505744;  // "SPWD"
  uint16_t version = kProtocol;
  uint16_t reserved = 0;
  uint32_t bytes = 0;
};
static_assert(sizeof(Header) == 12, "without padding");

/// Files that may come at once.
constexpr size_t kMaxFiles = 4;
constexpr size_t kReadBytes = 64 << 10;

/// Whether an error is final: EAGAIN and ENOBUFS only mean that the call must be repeated later.
bool is_refused(int error) {
  return error != EAGAIN && error != ENOBUFS;
}

}  // namespace

Channel::~Channel() {
  for (const Unsent& packet : unsent_) {
    if (packet.file >= 0) ::close(packet.file);
  }
  for (const int file : files_) ::close(file);
  ::close(socket_);
}

void Channel::send(const std::vector<uint8_t>& bytes, int file) {
  Header header;
  header.bytes = static_cast<uint32_t>(bytes.size());
  Unsent& packet = unsent_.emplace_back();
  packet.bytes.resize(sizeof header);
  std::memcpy(packet.bytes.data(), &header, sizeof header);
  packet.bytes.insert(packet.bytes.end(), bytes.begin(), bytes.end());
  if (file >= 0) packet.file = fcntl(file, F_DUPFD_CLOEXEC, 0);
  flush();
}

/// Returns false when the socket is full.
bool Channel::send_some(Unsent& packet) {
  iovec rest{packet.bytes.data() + packet.sent, packet.bytes.size() - packet.sent};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> space{};
  msghdr message{};
  message.msg_iov = &rest;
  message.msg_iovlen = 1;
  if (packet.file >= 0) {
    message.msg_control = space.data();
    message.msg_controllen = space.size();
    cmsghdr* const rights = CMSG_FIRSTHDR(&message);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(rights), &packet.file, sizeof(int));
  }
  const ssize_t sent =
      uninterrupted([&] { return sendmsg(socket_, &message, MSG_DONTWAIT | MSG_NOSIGNAL); });
  if (sent < 0) {
    is_gone_ |= is_refused(errno);
    return false;
  }
  packet.sent += static_cast<size_t>(sent);
  if (packet.file >= 0) ::close(packet.file);
  packet.file = -1;
  return true;
}

void Channel::flush() {
  while (!unsent_.empty() && !is_gone_ && send_some(unsent_.front())) {
    if (unsent_.front().sent == unsent_.front().bytes.size()) unsent_.pop_front();
  }
}

void Channel::fill() {
  std::array<uint8_t, kReadBytes> bytes;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kMaxFiles * sizeof(int))> space;
  while (!is_gone_ && received_.size() - taken_ <= sizeof(Header) + limits_.bytes) {
    iovec room{bytes.data(), bytes.size()};
    msghdr message{};
    message.msg_iov = &room;
    message.msg_iovlen = 1;
    message.msg_control = space.data();
    message.msg_controllen = space.size();
    const ssize_t got =
        uninterrupted([&] { return recvmsg(socket_, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC); });
    if (got <= 0) {
      is_gone_ |= got == 0 || is_refused(errno);
      return;
    }
    received_.insert(received_.end(), bytes.begin(), bytes.begin() + got);
    for (cmsghdr* part = CMSG_FIRSTHDR(&message); part; part = CMSG_NXTHDR(&message, part)) {
      if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) continue;
      const size_t count = std::min((part->cmsg_len - CMSG_LEN(0)) / sizeof(int), kMaxFiles);
      std::array<int, kMaxFiles> files{};
      std::memcpy(files.data(), CMSG_DATA(part), count * sizeof(int));
      files_.insert(files_.end(), files.begin(), files.begin() + static_cast<ptrdiff_t>(count));
    }
    if (files_.size() > limits_.files) mark_incompatible();
  }
}

std::optional<std::vector<uint8_t>> Channel::next() {
  Header header;
  const Header own;
  if (received_.size() - taken_ < sizeof header) return std::nullopt;
  std::memcpy(&header, received_.data() + taken_, sizeof header);
  if (header.magic != own.magic || header.version != own.version || header.bytes > limits_.bytes) {
    mark_incompatible();
    return std::nullopt;
  }
  if (received_.size() - taken_ - sizeof header < header.bytes) return std::nullopt;
  const auto first = received_.begin() + static_cast<ptrdiff_t>(taken_ + sizeof header);
  std::vector<uint8_t> packet(first, first + header.bytes);
  taken_ += sizeof header + header.bytes;
  if (taken_ == received_.size() || taken_ > limits_.bytes) {
    received_.erase(received_.begin(), received_.begin() + static_cast<ptrdiff_t>(taken_));
    taken_ = 0;
  }
  return packet;
}

int Channel::take_file() {
  if (files_.empty()) return -1;
  const int file = files_.front();
  files_.pop_front();
  return file;
}

}  // namespace spidar::window
