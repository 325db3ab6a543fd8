// For the checker of distances: finds the triangles of entries in the scene, and proves that all
// other pairs are farther apart.
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

/// The entries in order. Throws Error naming `name` if an entry names an object or a triangle that
/// the scene does not have.
std::vector<Listed> located(const DistanceCertificate& certificate, const Scene& scene,
                            const std::string& name);

// Decides in integers, on all cores, whether each of many pairs of triangles is farther apart than
// its length.

class FarProof {
 public:
  /// A pair that has to be farther apart than the length (with or_as_far: at least as far).
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
  /// How many jobs have been added and not decided.
  std::size_t waiting() const { return jobs_.size(); }
  /// Decides the waiting jobs.
  void decide();

  /// The first decided job, by question and then by pair, whose pair is not far enough. Leaves out
  /// jobs with an entry whose pair is exactly as near as the pair of the entry (as_near()).
  const std::optional<Job>& nearer() const { return nearer_; }
  /// The first decided job whose pair is not far enough, but exactly as near as the pair of its
  /// entry. Jobs behind nearer() are left out.
  const std::optional<Job>& as_near() const { return as_near_; }

 private:
  bool holds(const Job& job) const;
  bool is_nearer(const Job& job) const;

  const Scene& scene_;
  std::vector<Job> jobs_;
  std::optional<Job> nearer_, as_near_;
};

}  // namespace farcull
