// FAR pairs on the cores of the CPU: the kernels of core/interval.glsl compiled as C++.
#pragma once

#include <cstddef>
#include <memory>

#include "core/pair_backend.h"

namespace farcull {

/// threads: 0 for as many as there are cores. memory: bytes, about, that the masks and lists of one
/// part of the window may take in each thread; more entries split the window further, down to
/// single pixels, which take what they need. The answer depends on neither.
std::unique_ptr<PairBackend> cpu_pair_backend(unsigned threads = 0,
                                              std::size_t memory = std::size_t{256} << 20);

}  // namespace farcull
