// The report in which a device says what it has read and done (assumption A7), for the GL canvas.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/gl/context.h"
#include "core/gl/objects.h"

namespace farcull {

/// The binding of the report in every program of the canvas.
constexpr GLuint kReport = 3;

/// Throws Error naming the GL stage: a command was lost, `reason` says how that was seen.
[[noreturn]] void throw_lost(const std::string& stage, const std::string& reason);

/// Throws Error: GL does not have `what` as it was set.
[[noreturn]] void throw_lost_state(const char* what);

/// A storage buffer into which every batch of draws writes its echo, every dispatch its own and the
/// number of its work items that finished, and which holds the flags of a pass.
class CanvasReport {
 public:
  static constexpr std::uint32_t kHead = 2;  // words before the echoes: finished, sum

  /// block: bytes of data in a storage block; alignment: of a storage buffer range, in bytes.
  CanvasReport(const GlContext& context, std::size_t block, std::size_t alignment);

  /// Expects `runs` batches of draws and at most `dispatches` dispatches; `flags` to be packed.
  void start(std::size_t runs, std::size_t dispatches, std::uint32_t flags);
  /// The dispatches that expect() makes for so many bytes.
  std::size_t dispatches(std::size_t bytes) const { return (bytes + piece_ - 1) / piece_; }
  /// Lets the device sum what the store holds from its beginning; read() compares the sum with that
  /// of `data`, of a multiple of 16 bytes.
  void expect(const GlStore& store, std::span<const std::byte> data);
  /// The echo of batch `run`, which writes it to word kHead + run.
  void expect_run(std::size_t run, std::uint32_t echo) { echoes_[run] = echo; }
  /// Lets the device pack the flags that hold `serial`; the last dispatch before read().
  void pack(const GlStore& flags, std::uint32_t serial, std::uint32_t count);
  /// Waits and reads. Throws Error naming `stage` unless every echo and the sum are those that were
  /// expected, every work item finished and GL has no error. A flag each, where pack() was called.
  std::vector<std::uint8_t> read(const std::string& stage);
  const GlStore& store() const { return store_; }
  /// Of all passes: dispatches that were started, and bytes that were read.
  std::uint64_t dispatches_in_all() const { return dispatches_; }
  std::uint64_t bytes_in_all() const { return bytes_; }

 private:
  struct Numbers {  // the uniforms of canvas_work.comp
    std::uint32_t count, echo, serial, flags, bits;
  };
  void dispatch(std::uint32_t step, const GlStore& from, std::size_t offset, std::size_t bytes,
                std::uint32_t tag, const Numbers& numbers, std::uint32_t groups);

  const GlContext& context_;
  std::size_t block_, piece_;
  std::array<GlProgram, 2> programs_;  // by step: sum, pack
  GlStore store_;
  std::vector<std::uint32_t> echoes_;     // expected: of the batches, then of the dispatches
  std::uint32_t finished_ = 0, sum_ = 0;  // expected
  std::uint32_t flags_ = 0;               // packed
  std::uint64_t dispatches_ = 0, bytes_ = 0;
};

}  // namespace farcull
