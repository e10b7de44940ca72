// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/transports/websocket_transport.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <libwebsockets.h>
#include <sys/ioctl.h>
#include <utility>
#include <vector>

#include "spidar/device.h"
#include "spidar/realtime/monotonic.h"

namespace spidar {
namespace {

constexpr const char* kHost = "localhost";
/// The address is not looked up, because a container may have no /etc/hosts.
constexpr const char* kAddress = "127.0.0.1";
constexpr int64_t kGreetingWait_ns = 2 * kSecond_ns;
constexpr int64_t kAnswerWait_ns = 5'000'000;
constexpr size_t kLongest = 4096;
/// More than the files of a connection and of its loop. Without a limit, libwebsockets fills tables
/// for as many files as the process may open.
constexpr unsigned kMostFiles = 16;
/// The longest answer, bytes. No device service sends a longer one.
constexpr size_t kMax = 1 << 20;

/// Wakes the loop of libwebsockets, which may look at its timers just before it waits.
struct Alarm {
  lws_sorted_usec_list_t entry{};  // first, so that it has the address of the alarm
  lws_context* context = nullptr;

  static void ring(lws_sorted_usec_list_t* entry) {
    lws_cancel_service(reinterpret_cast<Alarm*>(entry)->context);
  }
};

}  // namespace

class WebSocketTransport::Connection {
 public:
  explicit Connection(uint16_t port);
  ~Connection() { lws_context_destroy(context_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool wait_until_open(int64_t deadline_ns) {
    return run([this] { return state_ != State::kConnecting; }, deadline_ns) &&
           state_ == State::kOpen;
  }
  bool receive(int64_t deadline_ns) {
    return run([this] { return complete_ || gone(); }, deadline_ns) && finish();
  }
  /// Reads and drops received data until there is no more, or until `until_ns`.
  StaleData drop_stale_data(int64_t until_ns);
  void send(std::initializer_list<ByteView> packets) noexcept;

  bool gone() const noexcept { return state_ == State::kGone; }
  /// Whether the last message has been answered.
  bool answered() const noexcept { return pending_ == 0 && !asked_; }
  const std::vector<uint8_t>& answer() const noexcept { return incoming_; }
  int file() const noexcept { return lws_get_socket_fd(socket_); }
  const std::string& error() const noexcept { return error_; }

 private:
  enum class State { kConnecting, kOpen, kGone };

  static int handle(lws* socket, lws_callback_reasons reason, void*, void* in, size_t length);
  void receive_fragment(const uint8_t* bytes, size_t length);
  void write();
  bool finish() noexcept;
  bool has_unread() const noexcept;
  template <typename Done>
  bool run(const Done& done, int64_t deadline_ns);

  const std::array<lws_protocols, 2> protocols_{lws_protocols{"", handle, 0, 0, 0, nullptr, 0},
                                                lws_protocols{}};
  lws_context* context_ = nullptr;
  lws* socket_ = nullptr;
  Alarm alarm_;
  State state_ = State::kConnecting;
  std::string error_;
  std::array<uint8_t, LWS_PRE + kLongest> outgoing_{};
  size_t pending_ = 0;     ///< length of the message that waits to be written
  bool asked_ = true;      ///< whether an answer is due; the first one is the greeting
  bool counts_ = false;    ///< whether arriving data is an answer
  bool complete_ = false;  ///< whether an answer has arrived
  bool surplus_ = false;   ///< whether other data has arrived
  std::vector<uint8_t> incoming_;
};

WebSocketTransport::Connection::Connection(uint16_t port) {
  // The level applies to the whole process; the default prints what this class reports itself.
  lws_set_log_level(0, nullptr);
  lws_context_creation_info about{};
  about.port = CONTEXT_PORT_NO_LISTEN;
  about.protocols = protocols_.data();
  about.user = this;
  about.fd_limit_per_thread = kMostFiles;
  about.http_proxy_address = "";  // no proxy of the environment: the service is on this computer
  // libwebsockets ignores SIGPIPE for the whole process, although it sends with MSG_NOSIGNAL.
  struct sigaction of_process {};
  sigaction(SIGPIPE, nullptr, &of_process);
  context_ = lws_create_context(&about);
  sigaction(SIGPIPE, &of_process, nullptr);
  if (!context_) throw DeviceError("libwebsockets cannot be used");
  alarm_.context = context_;
  lws_client_connect_info to{};
  to.context = context_;
  to.address = kAddress;
  to.host = kHost;
  to.port = port;
  to.path = "/";
  to.local_protocol_name = protocols_[0].name;
  to.pwsi = &socket_;
  if (!lws_client_connect_via_info(&to)) state_ = State::kGone;
}

int WebSocketTransport::Connection::handle(lws* socket, lws_callback_reasons reason, void*,
                                           void* in, size_t length) {
  auto* self = static_cast<Connection*>(lws_context_user(lws_get_context(socket)));
  switch (reason) {
    case LWS_CALLBACK_CLIENT_ESTABLISHED:
      self->state_ = State::kOpen;
      break;
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
      if (in) self->error_.assign(static_cast<const char*>(in), length);
      self->state_ = State::kGone;
      break;
    case LWS_CALLBACK_CLIENT_CLOSED:
      self->state_ = State::kGone;
      break;
    case LWS_CALLBACK_CLIENT_RECEIVE:
      self->receive_fragment(static_cast<const uint8_t*>(in), length);
      break;
    case LWS_CALLBACK_CLIENT_WRITEABLE:
      self->write();
      break;
    default:
      break;
  }
  return 0;
}

void WebSocketTransport::Connection::receive_fragment(const uint8_t* bytes, size_t length) {
  if (lws_is_first_fragment(socket_)) {
    surplus_ = surplus_ || complete_ || !asked_;
    counts_ = asked_;
    complete_ = false;
    incoming_.clear();
  }
  if (incoming_.size() + length <= kMax) incoming_.insert(incoming_.end(), bytes, bytes + length);
  complete_ = counts_ && lws_is_final_fragment(socket_) != 0;
}

/// Returns whether there was an answer.
bool WebSocketTransport::Connection::finish() noexcept {
  if (complete_) asked_ = false;
  return std::exchange(complete_, false);
}

bool WebSocketTransport::Connection::has_unread() const noexcept {
  int unread = 0;
  return !gone() && ioctl(file(), FIONREAD, &unread) == 0 && unread > 0;
}

Transport::StaleData WebSocketTransport::Connection::drop_stale_data(int64_t until_ns) {
  bool is_in_time = true;
  while (is_in_time && has_unread()) {
    is_in_time = monotonic_now_ns() < until_ns;
    // With −1, libwebsockets reads what has arrived, and does not wait.
    if (lws_service(context_, -1) < 0) state_ = State::kGone;
  }
  finish();
  if (!is_in_time) return StaleData::kEndless;
  return std::exchange(surplus_, false) ? StaleData::kDropped : StaleData::kNone;
}

void WebSocketTransport::Connection::write() {
  if (pending_ == 0) return;
  const int written = lws_write(socket_, outgoing_.data() + LWS_PRE, pending_, LWS_WRITE_TEXT);
  if (written < static_cast<int>(pending_)) state_ = State::kGone;
  pending_ = 0;
  asked_ = true;
}

void WebSocketTransport::Connection::send(std::initializer_list<ByteView> packets) noexcept {
  pending_ = 0;
  for (const ByteView packet : packets) {
    const size_t length = std::min(packet.size, kLongest - pending_);
    std::copy_n(packet.data, length, outgoing_.data() + LWS_PRE + pending_);
    pending_ += length;
  }
  lws_callback_on_writable(socket_);
}

/// Runs the loop of libwebsockets. Returns false at the deadline.
template <typename Done>
bool WebSocketTransport::Connection::run(const Done& done, int64_t deadline_ns) {
  while (!done()) {
    const int64_t left_ns = deadline_ns - monotonic_now_ns();
    if (left_ns <= 0) break;
    lws_sul_schedule(context_, 0, &alarm_.entry, Alarm::ring, left_ns / 1000 + 1);
    if (lws_service(context_, 0) < 0) state_ = State::kGone;
    if (gone()) break;
  }
  // From version 4.3.5 on, libwebsockets ends the process if the function is null, even here.
  lws_sul_schedule(context_, 0, &alarm_.entry, Alarm::ring, LWS_SET_TIMER_USEC_CANCEL);
  return done();
}

WebSocketTransport::WebSocketTransport(std::string name, uint16_t port, std::string cure)
    : name_(std::move(name)), port_(port), cure_(std::move(cure)) {}

WebSocketTransport::~WebSocketTransport() {
  close();
}

void WebSocketTransport::open() {
  close();
  const int64_t deadline_ns = monotonic_now_ns() + kGreetingWait_ns;
  const std::string at = std::string(kHost) + ":" + std::to_string(port_);
  auto connection = std::make_unique<Connection>(port_);
  if (!connection->wait_until_open(deadline_ns)) {
    throw DeviceError(name_ + ": no service answers at " + at +
                          (connection->error().empty() ? "" : " (" + connection->error() + ")") +
                          "; " + cure_,
                      DeviceErrorCode::kAbsent);
  }
  if (!connection->receive(deadline_ns)) {
    throw DeviceError(name_ + ": the service at " + at + " does not say what is plugged in; " +
                      cure_);
  }
  connection_ = std::move(connection);
}

Transfer WebSocketTransport::transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                                      int64_t deadline_ns) noexcept {
  if (!connection_ || connection_->gone()) return {LinkFault::kGone, 0};
  if (!connection_->answered()) connection_->receive(deadline_ns);
  // The connection may have ended with that answer, and libwebsockets has freed it.
  if (connection_->answered() && !connection_->gone()) {
    connection_->send(packets);
    connection_->receive(deadline_ns);
  }
  if (connection_->gone()) return {LinkFault::kGone, 0};
  if (!connection_->answered()) return {LinkFault::kTimeout, 0};
  const std::vector<uint8_t>& answer = connection_->answer();
  const size_t length = std::min(answer.size(), reply.size);
  std::copy_n(answer.begin(), length, reply.data);
  if (answer.size() > reply.size) return {LinkFault::kBabble, length};
  return {length < reply.size ? LinkFault::kShort : LinkFault::kNone, length};
}

Transport::StaleData WebSocketTransport::drop_stale_data(int64_t until_ns) noexcept {
  return connection_ ? connection_->drop_stale_data(until_ns) : StaleData::kNone;
}

void WebSocketTransport::recover() noexcept {
  if (connection_ && !connection_->answered()) {
    connection_->receive(monotonic_now_ns() + kAnswerWait_ns);
  }
}

std::optional<LastWill> WebSocketTransport::last_will() const {
  if (!connection_ || connection_->gone()) {
    throw DeviceError(name_ + ": the service has ended", DeviceErrorCode::kAbsent);
  }
  LastWill will;
  will.wire = LastWill::Wire::kSocket;
  will.file = connection_->file();
  return will;
}

void WebSocketTransport::close() noexcept {
  connection_.reset();
}

}  // namespace spidar
