// FAR pairs on OpenGL 4.3: the kernels of core/interval.glsl as compute shaders
// (core/shaders/pair_*).
#pragma once

#include <cstddef>
#include <memory>

#include "core/gl_context.h"
#include "core/pair_backend.h"

namespace farcull {

struct GlPairOptions {
  /// Bytes that the masks and lists of one part of the window may take; more split the window, down
  /// to single pixels. The answer does not depend on it.
  std::size_t memory = std::size_t{256} << 20;
  long storage_limit =
      0;  // bytes; as if a storage block held no more than this. 0: the device's own limit
};

/// Faults for tests, each applied to the next raw_pairs; it must notice every one (assumption A7).
enum class PairFault {
  none,
  lost_dispatch,       // a dispatch never runs
  oversized_dispatch,  // a dispatch is beyond the device's limit
  unfinished_item,     // a work item of a dispatch gives up
  corrupted_count,     // the count of a list changes before the list is filled in
  stale_bits,  // bits of settled pairs are not cleared: the only one that nothing notices, for a
               // test that pairs are lost by it
};

class GlPairs final : public PairBackend {
 public:
  /// Compiles its programs. Throws Error where the device has too few storage bindings or refuses a
  /// program. The context must outlive the backend, which makes it current for each of its calls.
  explicit GlPairs(const GlContext& context, const GlPairOptions& options = {});
  ~GlPairs() override;

  std::string name() const override;
  /// Also throws Error where the entries of a single pixel are beyond a storage block of the
  /// device. After any exception all that lies on the device is dropped; the next call makes it
  /// anew.
  std::vector<TrianglePair> raw_pairs(const PairTask& task, PairCounts& counts) override;

  /// `at`: which dispatch of the next raw_pairs, or which of the first part's lists, is at fault.
  void inject(PairFault fault, std::size_t at);
  /// Of the last raw_pairs.
  std::size_t dispatches() const;
  std::size_t uploaded_bytes() const;

 private:
  struct State;
  void forget();
  const GlContext& context_;
  GlPairOptions options_;
  std::unique_ptr<State> state_;  // null after a failure
};

/// The same behind the interface; memory as in GlPairOptions.
std::unique_ptr<PairBackend> gl_pair_backend(const GlContext& context,
                                             std::size_t memory = std::size_t{256} << 20);

}  // namespace farcull
