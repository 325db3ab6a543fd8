// A direction proves that a pair is far enough; if no direction does, its nearest points prove that
// it is not.
#include "verify/certificate/far_proof.h"

#include <stdexcept>
#include <utility>

#include "core/base/parallel.h"
#include "verify/certificate/integer_distance.h"

namespace farcull {

void FarProof::decide() {
  constexpr std::size_t kPerThread = 256;  // enough of them to pay for a thread
  std::vector<std::uint8_t> fails(jobs_.size());
  for_chunks(jobs_.size(), chunks_for(jobs_.size(), kPerThread),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i) fails[i] = !holds(jobs_[i]);
             });
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    if (fails[i] == 0) continue;
    const Job& job = jobs_[i];
    std::optional<Job>& first = is_nearer(job) ? nearer_ : as_near_;
    if (!first || std::pair(job.question, job.pair) < std::pair(first->question, first->pair))
      first = job;
  }
  jobs_.clear();
}

bool FarProof::holds(const Job& job) const {
  return job.length != nullptr && is_beyond(scene_.corners(job.pair.a), scene_.corners(job.pair.b),
                                            *job.length, job.or_as_far);
}

bool FarProof::is_nearer(const Job& job) const {
  if (job.length == nullptr) return true;
  const IntegerDistance exact =
      integer_distance(scene_.corners(job.pair.a), scene_.corners(job.pair.b));
  const auto order = exact.squared <=> job.length->squared;
  if (order > 0 || (order == 0 && job.or_as_far)) {
    throw std::logic_error(
        "check_distances: neither does a direction show that two triangles are far apart, nor are "
        "their nearest points near");
  }
  return order < 0 || !job.entry;
}

}  // namespace farcull
