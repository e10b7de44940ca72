// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <libwebsockets.h>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <vector>

#include "spidar/devices/inverse3/packets.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::test {

/// Emulates Haply's Inverse Service on a port of this computer: greets, and answers each message
/// with one. Keeps a force until another one arrives, also when its sender is gone: the real
/// service releases the grip after a time that is not published.
class InverseService {
 public:
  /// Port 0 means any port.
  explicit InverseService(int port = 0) {
    lws_set_log_level(0, nullptr);
    lws_context_creation_info about{};
    about.port = port;
    about.iface = "127.0.0.1";
    about.protocols = protocols_.data();
    about.user = this;
    context_ = lws_create_context(&about);
    if (!context_) throw std::runtime_error("no port for the service");
    port_ = lws_get_vhost_listen_port(lws_get_vhost_by_name(context_, "default"));
    thread_ = std::thread([this] {
      while (!stop_) lws_service(context_, 0);
    });
  }
  /// Ends like a killed service: connections are reset.
  ~InverseService() {
    stop_ = true;
    lws_cancel_service(context_);
    thread_.join();
    lws_context_destroy(context_);
  }
  InverseService(const InverseService&) = delete;
  InverseService& operator=(const InverseService&) = delete;

  int port() const { return port_; }
  /// The name for make_grip().
  std::string spec(const std::string& id) const {
    return "inverse3:" + id + ",port=" + std::to_string(port_);
  }

  /// Replaces all devices.
  void plug(std::vector<inverse3::State> devices) {
    const std::lock_guard lock(mutex_);
    devices_ = std::move(devices);
  }
  static inverse3::State device(const std::string& id) {
    inverse3::State state;
    state.id = id;
    state.version = inverse3::Version::k35;
    return state;
  }
  Eigen::Vector3d force_N(const std::string& id) {
    const std::lock_guard lock(mutex_);
    return id == first_ ? force_N_[0] : force_N_[1];
  }
  bool pulls() {
    const std::lock_guard lock(mutex_);
    return !force_N_[0].isZero(0);
  }

  /// Does not answer messages that contain `key`.
  void ignore(const std::string& key) {
    const std::lock_guard lock(mutex_);
    ignored_ = key;
  }

  /// Sends this number of states without a request.
  void burst(int number) {
    unasked_ = number;
    lws_cancel_service(context_);
  }

  /// Sends a state without a request, and with it a frame that RFC 6455 forbids.
  void break_protocol() {
    breaks_ = true;
    lws_cancel_service(context_);
  }

  std::string first_ = "049D";      ///< the device of the first force
  std::atomic<bool> mute{false};    ///< accepts messages, but does not answer
  std::atomic<int> held{0};         ///< unanswered messages that it did not answer
  std::atomic<bool> broken{false};  ///< answers with invalid JSON
  std::atomic<int> answers{1};      ///< to each message
  std::atomic<int> states{0};       ///< states made so far; each has its number
  std::atomic<int> unsent{0};       ///< answers that are due
  std::atomic<int> clients{0};      ///< connections so far
  std::atomic<int> messages{0};
  std::atomic<int64_t> let_go_ns{0};  ///< when the first force became zero

 private:
  /// A session stores the number of due answers.
  static int handle(lws* socket, lws_callback_reasons reason, void* session, void* in,
                    size_t length) {
    int* due = static_cast<int*>(session);
    auto* self = static_cast<InverseService*>(lws_context_user(lws_get_context(socket)));
    if (reason == LWS_CALLBACK_ESTABLISHED) self->greet(socket, *due);
    if (reason == LWS_CALLBACK_RECEIVE)
      self->take(socket, *due, static_cast<const char*>(in), length);
    if (reason == LWS_CALLBACK_SERVER_WRITEABLE) self->write(socket, *due);
    if (reason == LWS_CALLBACK_EVENT_WAIT_CANCELLED) self->write_unasked();
    return 0;
  }

  void greet(lws* socket, int& due) {
    ++clients;
    newest_ = socket;
    due = 1;
    ++unsent;
    lws_callback_on_writable(socket);
  }

  void take(lws* socket, int& due, const char* bytes, size_t length) {
    if (lws_is_first_fragment(socket)) incoming_.clear();
    incoming_.append(bytes, length);
    if (!lws_is_final_fragment(socket)) return;
    ++messages;
    keep_forces();
    if (mute || is_ignored()) {
      ++held;
      return;
    }
    due += answers;
    unsent += answers;
    lws_callback_on_writable(socket);
  }

  bool is_ignored() {
    const std::lock_guard lock(mutex_);
    return !ignored_.empty() && incoming_.find(ignored_) != std::string::npos;
  }

  void keep_forces() {
    const std::lock_guard lock(mutex_);
    const ByteView text(reinterpret_cast<const uint8_t*>(incoming_.data()), incoming_.size());
    for (const inverse3::State& device : devices_) {
      Eigen::Vector3d& kept_N = force_N_[device.id == first_ ? 0 : 1];
      const bool pulled = !kept_N.isZero(0);
      inverse3::decode_force(text, device.id, kept_N);
      if (pulled && kept_N.isZero(0) && device.id == first_) let_go_ns = monotonic_now_ns();
    }
  }

  /// All devices in one message.
  std::string text() {
    if (broken) return "<html>no JSON</html>";
    const std::lock_guard lock(mutex_);
    nlohmann::json all = {
        {"session_id", 1}, {"number", ++states}, {"inverse3", nlohmann::json::array()}};
    for (const inverse3::State& device : devices_) {
      std::array<uint8_t, inverse3::kCommandSize> bytes{};
      const size_t length = inverse3::encode_state(device, bytes);
      const nlohmann::json one = nlohmann::json::parse(bytes.begin(), bytes.begin() + length);
      all["inverse3"].push_back(one["inverse3"][0]);
      all["wireless_verse_grip"] = one["wireless_verse_grip"];
    }
    return all.dump();
  }

  void write(lws* socket, int& due) {
    if (due == 0) return;
    --due;
    const std::string answer = std::string(LWS_PRE, '\0') + text();
    std::vector<uint8_t> bytes(answer.begin(), answer.end());
    lws_write(socket, bytes.data() + LWS_PRE, bytes.size() - LWS_PRE, LWS_WRITE_TEXT);
    --unsent;
    if (due > 0) lws_callback_on_writable(socket);
  }

  /// Writes all frames at once, so that they arrive together.
  void write_unasked() {
    const bool breaks = breaks_.exchange(false);
    std::string frames;
    for (int left = unasked_.exchange(0) + (breaks ? 1 : 0); left > 0; --left) {
      const std::string state = text();
      frames += "\x81\x7E";  // the last frame of a text, whose length follows in two bytes
      frames += {static_cast<char>(state.size() >> 8), static_cast<char>(state.size() & 0xFF)};
      frames += state;
    }
    if (breaks) frames += {'\x83', '\0'};  // no kind of frame has the number 3
    send(lws_get_socket_fd(newest_), frames.data(), frames.size(), MSG_NOSIGNAL);
  }

  const std::array<lws_protocols, 2> protocols_{
      lws_protocols{"", handle, sizeof(int), 0, 0, nullptr, 0}, lws_protocols{}};
  lws_context* context_ = nullptr;
  int port_ = 0;
  std::string ignored_;
  std::atomic<bool> stop_{false}, breaks_{false};
  std::atomic<int> unasked_{0};
  lws* newest_ = nullptr;
  std::string incoming_;
  std::mutex mutex_;
  std::vector<inverse3::State> devices_{device("049D")};
  std::array<Eigen::Vector3d, 2> force_N_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::thread thread_;
};

}  // namespace spidar::test
