// The search for the nearest triangles of two objects: branch and bound over pairs of nodes of
// their trees.
//
// A search works until it has looked at as many pairs of leaves as it may, and can go on then, or
// be divided into searches that go on side by side. Its result depends on the scene, the question
// and the hint alone, since no search looks at the results of another one.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/proximity/near_pairs.h"
#include "core/proximity/scene_trees.h"

namespace farcull {

/// Two nodes of trees, by height and number; the square of the gap of their boxes.
struct NodePair {
  double square;
  std::uint32_t a, b;
  std::uint8_t a_height, b_height;
};

/// A pair of triangles that may be nearest; bounds of its distance in scaled units.
struct KeptPair {
  TrianglePair pair;
  double lower, upper;
};

/// A search that has begun.
struct Search {
  ObjectPair objects;
  double limit = 0;  // scaled: pairs farther apart are not looked for
  double upper = std::numeric_limits<double>::infinity();  // the least one of a pair so far
  /// The first pair so far that meets for certain. Then a pair behind it is no answer.
  TrianglePair first = {UINT32_MAX, UINT32_MAX};
  Vec3 direction = Vec3::Zero();  // of that pair; 0: none
  std::vector<NodePair> open;     // to be looked at, the last one first
  std::vector<KeptPair> kept;
  bool everything = false;       // all pairs within the limit are kept, near or not
  std::size_t kept_most = 1024;  // more than this: those that cannot be nearest are dropped first
  ProximityCounts counts;

  double bound() const { return everything ? limit : std::min(upper, limit); }
  bool is_behind(const TrianglePair& pair) const { return !everything && pair > first; }
  /// Drops pairs that cannot be the answer.
  void filter();
};

/// Memory that a thread uses again in all its searches.
class SearchMemory {
 public:
  static constexpr std::uint32_t kLeaves = 64;
  SearchMemory() : a(kLeaves), b(kLeaves) {}
  /// Before searches in another scene.
  void forget() { *this = SearchMemory(); }

  std::vector<BlockCorners> a, b;  // leaves of the first and the second object, at leaf % kLeaves
  std::uint64_t directions = 0;    // so many were used
  PairBatch batch;
};

/// Begins a search. hint: null, or a pair of triangles that may be near.
Search begin_search(const SceneTrees& trees, const ObjectPair& objects, double limit,
                    const TrianglePair* hint, SearchMemory& memory);
/// Goes on until nothing is open, or `most` pairs of leaves were looked at.
void go_on(const SceneTrees& trees, std::size_t most, Search& search, SearchMemory& memory);

/// Pairs of leaves that a search looks at before it is asked whether it goes on. One that does is
/// long, and is divided.
constexpr std::size_t kLeafPairsAtOnce = 4096;

/// A limit in world units, scaled and rounded up.
double scaled_limit(const SceneTrees& trees, double within);
/// The answer of a search with nothing open. Sets counts.kept.
NearPairs answer(const SceneTrees& trees, Search& search);
/// Pairs that a search may keep: 2.4 GB.
constexpr std::size_t kMostKept = 100'000'000;

/// Throws Error if a search keeps more than `most` pairs.
void require_room(const SceneTrees& trees, const Search& search, std::size_t most = kMostKept);
/// Ends a search. What it finds and counts does not depend on the number of threads. Throws Error
/// if it keeps more than `most` pairs.
void go_on_divided(const SceneTrees& trees, unsigned threads, Search& search,
                   std::size_t most = kMostKept);

}  // namespace farcull
