// The scene of FAR pairs on a GL device: what all parts of a window share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <vector>

#include "core/gl/pairs_device.h"
#include "core/pairs/backend.h"

namespace farcull {

/// The numbers of owners that are in the window.
struct PairOwners {
  std::uint32_t bits = 0;    // of the largest number
  std::uint32_t groups = 1;  // of entries, by owner
  bool same_group = true;    // entries of one group may collide
};

/// The triangles of a task as buffers of the device. Where an array is beyond a storage block,
/// triangles are gathered and sent in pieces, when they are needed.
class PairSceneStores {
 public:
  explicit PairSceneStores(PairQueue& device) : device_(device) {}

  /// Brings the buffers up to date; only what changed is sent. The task must outlive its use.
  PairOwners begin(const PairTask& task);
  bool gathered() const { return gathered_; }
  /// Bytes sent since begin().
  std::size_t sent_bytes() const { return sent_bytes_; }

  /// Calls launch(first, count) for the active triangles, all at once or as many as a block holds,
  /// when they are on the device.
  void for_each_piece(const std::function<void(std::size_t first, std::size_t count)>& launch);
  /// The buffers that every program about triangles reads, and `more`.
  std::vector<PairBinding> bindings(const GlStore& records, const GlStore& record_heads,
                                    std::initializer_list<PairBinding> more) const;

 private:
  // Brings the buffers up to date; what they then hold is compared when totals are read.
  void send(const std::array<std::span<const std::byte>, 5>& data);

  PairQueue& device_;
  const PairTask* task_ = nullptr;
  PairMirror vertices_, triangles_, owners_, active_, objects_;
  std::vector<std::uint32_t> object_words_;  // as in pair_source.glsl
  bool gathered_ = false;
  std::size_t sent_bytes_ = 0;
};

}  // namespace farcull
