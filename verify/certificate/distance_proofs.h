// For the checker of distances: the entries of a certificate in the numbers of its scene, and the
// proof that all other pairs are farther apart.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/distance_certificate.h"
#include "verify/certificate/integers.h"

namespace farcull {

/// An entry with its triangles as the scene numbers them.
struct Listed {
  TrianglePair pair;
  Length length;
};

/// Entry by entry. Throws Error naming `name` where one names what the scene does not have.
std::vector<Listed> located(const DistanceCertificate& certificate, const Scene& scene,
                            const std::string& name);

// Many pairs of triangles of which each has to be farther apart than some length, decided in
// integers, on all cores.

class FarProof {
 public:
  /// A pair that has to be farther apart than the length, or at least as far.
  struct Job {
    TrianglePair pair;
    const Length* length = nullptr;  // null: infinite, which no pair satisfies
    bool or_as_far = false;
    std::uint64_t question = 0;        // numbered by the caller
    std::optional<std::size_t> entry;  // the pair of this entry is `length` apart
  };

  /// The scene, and the lengths of the jobs, must outlive the object.
  explicit FarProof(const Scene& scene) : scene_(scene) {}

  void add(const Job& job) { jobs_.push_back(job); }
  /// How many have been added and not decided.
  std::size_t waiting() const { return jobs_.size(); }
  /// Decides the waiting jobs.
  void decide();

  /// The first decided pair, by question and then by pair, that is not far enough; not one that is
  /// exactly as near as the pair of its entry.
  const std::optional<Job>& nearer() const { return nearer_; }
  /// The first pair that is exactly as near as the pair of its entry.
  const std::optional<Job>& as_near() const { return as_near_; }

 private:
  bool holds(const Job& job) const;
  bool is_nearer(const Job& job) const;

  const Scene& scene_;
  std::vector<Job> jobs_;
  std::optional<Job> nearer_, as_near_;
};

}  // namespace farcull
