// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A transport to an emulated board, without a wire.
#pragma once

#include <atomic>
#include <memory>

#include "spidar/emulation/emulated_board.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Faults to be caused on the wire; must outlive the transport. Thread-safe.
struct EmulatedWire {
  /// The fault of every exchange. With kStall and kGone packets do not arrive; kBabble, kShort and
  /// kWrongReply spoil the reply.
  std::atomic<LinkFault> fault{LinkFault::kNone};
};

/// No time passes: a reply is available at once or not at all.
class EmulatedTransport final : public Transport {
 public:
  EmulatedTransport(std::unique_ptr<EmulatedBoard> board, std::shared_ptr<EmulatedWire> wire);

  void open() override;
  Transfer exchange(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept override;
  LinkFault control(const VendorRequest& request, int64_t deadline_ns) noexcept override;
  void recover() noexcept override;
  std::optional<LastWill> last_will() const override { return std::nullopt; }
  void close() noexcept override { open_ = false; }

 private:
  const std::unique_ptr<EmulatedBoard> board_;
  const std::shared_ptr<EmulatedWire> wire_;
  bool open_ = false;
};

}  // namespace spidar
