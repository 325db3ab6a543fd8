// Work of many items of unlike length, shared by all threads.
#pragma once

#include <atomic>
#include <cstddef>

#include "core/base/parallel.h"

namespace farcull {

/// Calls work(k, memory) once for each k in 0 .. count - 1, the next one by whichever thread is
/// free. Each thread makes a Memory, and uses it in all its calls. threads: 0 for as many as there
/// are cores. An exception of work is thrown again here (core/base/parallel.h).
template <class Memory, class Work>
void for_each_with_memory(std::size_t count, unsigned threads, const Work& work) {
  const std::size_t chunks = chunks_for(count, 1, threads);
  std::atomic<std::size_t> next = 0;
  for_chunks(chunks, chunks, [&](std::size_t, std::size_t, std::size_t) {
    Memory memory;
    for (std::size_t k = next++; k < count; k = next++) work(k, memory);
  });
}

/// The same with work(k).
template <class Work>
void for_each_shared(std::size_t count, unsigned threads, const Work& work) {
  struct Nothing {};
  for_each_with_memory<Nothing>(count, threads, [&](std::size_t k, Nothing&) { work(k); });
}

}  // namespace farcull
