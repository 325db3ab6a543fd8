// FAR pairs on the cores of the CPU: the kernels of core/pairs/interval.glsl compiled as C++.
#pragma once

#include <cstddef>
#include <memory>

#include "core/pairs/backend.h"

namespace farcull {

/// Pixels on a side of a window that this back end takes.
constexpr int kMostCpuPixels = 32767;

/// threads: 0 for as many as there are cores. memory: bytes, about, that the masks and lists of one
/// part of the window may take in each thread; more entries split the window further, down to
/// single pixels, which take what they need. An eighth of it on top holds which pairs were settled,
/// and an eighth of it for all threads together pairs that may repeat; beyond that as many pairs
/// are held as are distinct (core/scene/pair_sort.h). The answer depends on neither.
std::unique_ptr<PairBackend> cpu_pair_backend(unsigned threads = 0,
                                              std::size_t memory = std::size_t{256} << 20);

/// The same in one thread for tasks whose active triangles are some of `count`: large ones are
/// those that are large among all of these.
std::unique_ptr<PairBackend> cpu_sample_backend(std::size_t count);

}  // namespace farcull
