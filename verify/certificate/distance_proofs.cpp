// Every index is compared with the scene before it is used. A direction proves that a pair is far
// enough; if no direction does, the nearest points prove that the pair is not far enough.
#include "verify/certificate/distance_proofs.h"

#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "verify/certificate/integer_distance.h"

namespace farcull {
namespace {

constexpr const char* kOtherScene = "give the scene that the certificate was written for";

}  // namespace

std::vector<Listed> located(const DistanceCertificate& certificate, const Scene& scene,
                            const std::string& name) {
  std::vector<Listed> out;
  for (const DistanceEntry& entry : certificate.distances) {
    const std::string place = "distances[" + std::to_string(out.size()) + "]";
    std::array<std::uint32_t, 2> triangles{};
    for (int side = 0; side < 2; ++side) {
      const std::uint32_t object = entry.objects[side];
      const bool known = object < scene.objects.size();
      if (!known || entry.triangles[side] >= scene.objects[object].triangle_count) {
        throw Error(name,
                    place + " names " +
                        (known ? "triangle " + std::to_string(entry.triangles[side]) + " of object "
                               : std::string("object ")) +
                        std::to_string(object) + ", which the scene does not have",
                    kOtherScene);
      }
      triangles[side] = scene.objects[object].first_triangle + entry.triangles[side];
    }
    const std::optional<Fraction> squared = parse_fraction(entry.squared);
    if (!squared) throw std::logic_error("check_distances: " + place + " has no square");
    out.push_back({{triangles[0], triangles[1]}, Length(*squared)});
  }
  return out;
}

// ---- far pairs ----

void FarProof::decide() {
  constexpr std::size_t kPerThread = 256;  // jobs per thread, enough to pay for it
  std::vector<std::uint8_t> fails(jobs_.size());
  for_chunks(jobs_.size(), chunks_for(jobs_.size(), kPerThread),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i) fails[i] = !holds(jobs_[i]);
             });
  const auto is_before = [](const Job& job, const std::optional<Job>& first) {
    return !first || std::pair(job.question, job.pair) < std::pair(first->question, first->pair);
  };
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    // Behind a pair that refutes the certificate no other one is asked for.
    if (fails[i] == 0 || !is_before(jobs_[i], nearer_)) continue;
    std::optional<Job>& first = is_nearer(jobs_[i]) ? nearer_ : as_near_;
    if (is_before(jobs_[i], first)) first = jobs_[i];
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
