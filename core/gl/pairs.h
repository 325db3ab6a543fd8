// FAR pairs on OpenGL 4.3: the kernels of core/pairs/interval.glsl as compute shaders
// (core/gl/shaders/pair_*).
#pragma once

#include <cstddef>
#include <memory>

#include "core/gl/context.h"
#include "core/gl/pairs_options.h"
#include "core/pairs/backend.h"

namespace farcull {

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

  /// Of the last raw_pairs.
  std::size_t dispatches() const;
  std::size_t uploaded_bytes() const;
  /// Portions in which pairs were read; one where all of them fitted into one buffer.
  std::size_t portions() const;
  /// Pairs that the programs reported, the same one as often as they did.
  std::size_t reported_pairs() const;

 private:
  void forget();
  const GlContext& context_;
  GlPairOptions options_;
  std::unique_ptr<PairFinder> finder_;  // null after a failure
};

/// The same behind the interface; memory as in GlPairOptions.
std::unique_ptr<PairBackend> gl_pair_backend(const GlContext& context,
                                             std::size_t memory = std::size_t{256} << 20);

}  // namespace farcull
