// The lists of peers, in the order of the tables. For a peer that this build does not have, the
// entry says why the peer is missing.
#include "experiments/peers/peer.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "verify/exact.h"

namespace farcull {
namespace {

std::atomic<std::uint64_t> last_id = 0;  // the last value that was given to a PeerCandidates::id_

struct Known {
  const char* name;
  const char* library;
  const char* package;  // Debian's package
};

constexpr Known kBroad[] = {{"cgal-boxes", "CGAL", "libcgal-dev"},
                            {"cgal-boxes-2000", "CGAL", "libcgal-dev"},
                            {"cgal-object-pairs", "CGAL", "libcgal-dev"},
                            {"cgal-aabb", "CGAL", "libcgal-dev"},
                            {"fcl-obb", "FCL", "libfcl-dev"},
                            {"embree-low", "Embree 3", "libembree-dev"},
                            {"embree-medium", "Embree 3", "libembree-dev"},
                            {"bullet-gimpact", "Bullet in double", "libbullet-dev"}};
constexpr Known kNarrow[] = {{"fcl-float", "FCL", "libfcl-dev"},
                             {"fcl-double", "FCL", "libfcl-dev"},
                             {"ode-trimesh", "ODE", "libode-dev"}};
constexpr Known kDistances[] = {{"fcl-double", "FCL", "libfcl-dev"},
                                {"fcl-float", "FCL", "libfcl-dev"},
                                {"cgal-aabb", "CGAL", "libcgal-dev"}};

std::vector<LibraryPeers> libraries_of_build() {
  std::vector<LibraryPeers> all;
#if FARCULL_WITH_CGAL
  all.push_back(cgal_library());
#endif
#if FARCULL_WITH_FCL
  all.push_back(fcl_library());
#endif
#if FARCULL_WITH_EMBREE
  all.push_back(embree_library());
#endif
#if FARCULL_WITH_BULLET
  all.push_back(bullet_library());
#endif
#if FARCULL_WITH_ODE
  all.push_back(ode_library());
#endif
  return all;
}

std::string why_missing(const Known& known) {
  if (!FARCULL_WITH_PEERS) return "built without peers (-DFARCULL_PEERS=OFF)";
  return std::string("built without ") + known.library + " (Debian: " + known.package + ")";
}

/// Returns the peers of a list. part: the member of LibraryPeers with the peers of this kind.
template <class PeerKind>
std::vector<PeerKind> listed(std::span<const Known> list,
                             std::vector<PeerKind> LibraryPeers::*part) {
  std::vector<LibraryPeers> libraries = libraries_of_build();
  std::vector<PeerKind> out;
  for (const Known& known : list) {
    PeerKind peer{.name = known.name, .library = known.library, .missing = why_missing(known)};
    for (LibraryPeers& library : libraries) {
      for (PeerKind& given : library.*part) {
        if (given.name == known.name) peer = std::move(given);
      }
    }
    out.push_back(std::move(peer));
  }
  return out;
}

}  // namespace

std::vector<Peer> all_peers() { return listed(kBroad, &LibraryPeers::broad); }
std::vector<Peer> narrow_peers() { return listed(kNarrow, &LibraryPeers::narrow); }
std::vector<DistancePeer> distance_peers() { return listed(kDistances, &LibraryPeers::distances); }
std::vector<PosePeer> pose_peers() {
#if FARCULL_WITH_FCL
  return {fcl_poses()};
#else
  return {{.name = "fcl-double", .missing = why_missing({"fcl-double", "FCL", "libfcl-dev"})}};
#endif
}

// ---- shared by the adapters ----

Peer plain_peer(const std::string& name, const std::string& library,
                BenchAnswer (*run)(const Scene&, unsigned threads),
                std::function<std::string(const Scene&)> refuses) {
  const auto set_up = [run](unsigned threads) -> BenchRun {
    return [run, threads](const Scene& scene) { return run(scene, threads); };
  };
  return {name, library, "", set_up, std::move(refuses)};
}

std::vector<std::uint32_t> objects_with_triangles(const Scene& scene) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    if (scene.objects[o].triangle_count > 0) out.push_back(o);
  }
  return out;
}

std::string refuse_degenerate(const Scene& scene, const char* reason) {
  return degenerate_triangles(scene) == 0 ? "" : reason;
}

PeerScene::PeerScene(const Scene& scene, bool with_boxes)
    : scene(scene),
      boxes(with_boxes ? triangle_boxes(scene) : std::vector<Box>{}),
      owner(owners(scene)) {
  std::size_t with_triangles = 0;
  two_sides = true;
  for (const Object& object : scene.objects) {
    if (object.triangle_count == 0) continue;
    if (++with_triangles == 2) second = object.first_triangle;
    two_sides = two_sides && !object.self;
  }
  two_sides = two_sides && with_triangles == 2;
  if (!two_sides) second = 0;
}

bool PeerScene::has_pairs() const {
  return !owner.empty() && (owner.front() != owner.back() || has_self(scene));
}

PeerCandidates::PeerCandidates(const Scene& scene, unsigned threads, bool parallel)
    : scene_(scene), threads_(threads), parallel_(parallel), id_(++last_id) {}

PeerCandidates::~PeerCandidates() = default;

PeerCandidates::Part& PeerCandidates::part() {
  thread_local std::pair<std::uint64_t, Part*> mine{0, nullptr};
  if (mine.first != id_) {
    const std::lock_guard lock(mutex_);
    parts_.emplace_back(new Part(*this));
    mine = {id_, parts_.back().get()};
  }
  return *mine.second;
}

void PeerCandidates::Part::decide(unsigned threads) {
  const Stopwatch exact;
  const ExactQuestion question{.threads = threads, .neighbours = false};
  const std::vector<TrianglePair> found = farcull::decide(all_.scene_, pending_, question).pairs;
  pairs_.insert(pairs_.end(), found.begin(), found.end());
  decided_ += pending_.size();
  pending_.clear();
  exact_ms_ += exact.ms();
}

BenchAnswer PeerCandidates::finish(double build_ms) {
  BenchAnswer answer{.build_ms = build_ms};
  if (parts_.empty()) part();
  Part& all = *parts_.front();
  for (const auto& part : parts_) {
    answer.exact_ms += part->exact_ms_;
    answer.candidate_pairs += part->decided_;
    if (part.get() == &all) continue;
    all.pending_.insert(all.pending_.end(), part->pending_.begin(), part->pending_.end());
    all.pairs_.insert(all.pairs_.end(), part->pairs_.begin(), part->pairs_.end());
  }
  if (parallel_) answer.exact_ms /= threads_;
  answer.candidate_pairs += all.pending_.size();
  const Stopwatch rest;
  all.decide(threads_);
  std::sort(all.pairs_.begin(), all.pairs_.end());
  answer.exact_ms += rest.ms();
  answer.pairs = std::move(all.pairs_);
  answer.candidates_ms = std::max(0.0, since_.ms() - answer.exact_ms);
  parts_.clear();
  return answer;
}

std::vector<PeerDistance> distances_of_pairs(
    const std::vector<std::uint32_t>& numbers, unsigned threads,
    const std::function<double(std::size_t i, std::size_t k)>& distance) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t k = i + 1; k < numbers.size(); ++k) pairs.emplace_back(i, k);
  }
  std::vector<PeerDistance> out(pairs.size());
  for_each_shared(pairs.size(), threads, [&](std::size_t t) {
    const auto [i, k] = pairs[t];
    out[t] = {numbers[i], numbers[k], distance(i, k)};
  });
  std::erase_if(out, [](const PeerDistance& d) { return std::isinf(d.distance); });
  return out;
}

}  // namespace farcull
