// Pairs of objects that nobody asks about: neither their triangles nor their distance.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/scene/object_pair.h"
#include "core/scene/scene.h"

namespace farcull {

/// Pairs of two different objects with a < b in each, sorted, each once.
std::vector<ObjectPair> in_order(std::vector<ObjectPair> pairs);

/// Removes the pairs of triangles of which the objects are an ignored pair; the others stay in
/// their order. Returns how many were removed. ignored: as in_order() gives them. Time O(pairs).
/// Throws std::logic_error where it names an object that the scene does not have.
std::uint64_t remove_ignored(const Scene& scene, std::span<const ObjectPair> ignored,
                             std::vector<TrianglePair>& pairs);

/// Throws Error where objects of the scene are ignored. who: it answers about all objects, as in
/// "farcull distance".
void require_nothing_ignored(const Scene& scene, const std::string& who);

/// Asks of one pair of triangles after the other.
class IgnoredObjects {
 public:
  /// As remove_ignored(). The scene is not kept.
  IgnoredObjects(const Scene& scene, std::span<const ObjectPair> ignored);
  bool any() const { return !others_.empty(); }
  bool operator()(const TrianglePair& pair) const;

 private:
  std::vector<std::uint32_t> owner_;  // per triangle
  // Per object b the objects a < b that are ignored with it: others_[first_[b]] to
  // others_[first_[b + 1]], ascending.
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> others_;
};

}  // namespace farcull
