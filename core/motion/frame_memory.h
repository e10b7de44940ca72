/// Memory for what is known only while a frame is looked at.
#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>

namespace spidar {

/// Hands out parts of one block, all of which are taken back at once when the next frame begins.
/// Beyond the block it takes from the heap: more costly, not wrong.
class FrameMemory {
 public:
  explicit FrameMemory(size_t bytes)
      : block_(std::make_unique<std::byte[]>(bytes)), resource_(block_.get(), bytes) {}

  /// Nothing that was made with resource() may be alive.
  void release() { resource_.release(); }
  std::pmr::memory_resource* resource() { return &resource_; }

 private:
  std::unique_ptr<std::byte[]> block_;
  std::pmr::monotonic_buffer_resource resource_;
};

}  // namespace spidar
