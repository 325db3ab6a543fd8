// FAR pairs on OpenGL 4.3: the kernels of core/pairs/interval.glsl as compute shaders
// (core/gl/pairs/pair_*).
#pragma once

#include <cstddef>
#include <memory>

#include "core/gl/base/context.h"
#include "core/pairs/backend.h"

namespace farcull {

struct GlPairOptions {
  /// Bytes for the masks and lists of one part of the window; if they need more, the window is
  /// split, down to single pixels. The pairs of a portion, and the further tests of a level, may
  /// each take as many bytes. The answer does not depend on it.
  std::size_t memory = std::size_t{256} << 20;
  /// The most bytes that a storage block is taken to hold. 0: the device's own limit.
  long storage_limit = 0;
  /// Reads counts between the steps even if they can be predicted. It takes more time; the answer
  /// does not depend on it. For tests of the steps.
  bool step_by_step = false;
};

class PairFinder;

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

  // The work of the last raw_pairs.
  std::size_t dispatches() const;
  std::size_t uploaded_bytes() const;
  /// Portions in which pairs were read; one if all of them fitted into one buffer.
  std::size_t portions() const;
  /// Pairs that the programs reported, repeats included.
  std::size_t reported_pairs() const;

 private:
  void forget();
  const GlContext& context_;
  GlPairOptions options_;
  std::unique_ptr<PairFinder> finder_;  // null after a failure
};

/// A GlPairs behind the interface PairBackend; memory as in GlPairOptions.
std::unique_ptr<PairBackend> gl_pair_backend(const GlContext& context,
                                             std::size_t memory = std::size_t{256} << 20);

}  // namespace farcull
