// For each object a list of those that it is ignored with: most objects have a short one or none.
#include "core/scene/ignored.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"

namespace farcull {

std::vector<ObjectPair> in_order(std::vector<ObjectPair> pairs) {
  for (ObjectPair& pair : pairs) {
    if (pair.a > pair.b) std::swap(pair.a, pair.b);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

IgnoredObjects::IgnoredObjects(const Scene& scene, std::span<const ObjectPair> ignored) {
  if (ignored.empty()) return;
  first_.assign(scene.objects.size() + 1, 0);
  for (const ObjectPair& pair : ignored) {
    if (pair.a >= pair.b || pair.b >= scene.objects.size())
      throw std::logic_error("ignored objects: a pair is not two objects of the scene, a < b");
    ++first_[pair.b + 1];
  }
  for (std::size_t o = 1; o < first_.size(); ++o) first_[o] += first_[o - 1];
  others_.resize(ignored.size());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const ObjectPair& pair : ignored) others_[next[pair.b]++] = pair.a;
  for (std::size_t o = 0; o + 1 < first_.size(); ++o)
    std::sort(others_.begin() + static_cast<std::ptrdiff_t>(first_[o]),
              others_.begin() + static_cast<std::ptrdiff_t>(first_[o + 1]));
  owner_ = owners(scene);
}

bool IgnoredObjects::operator()(const TrianglePair& pair) const {
  if (!any()) return false;
  const auto [a, b] = std::minmax(owner_[pair.a], owner_[pair.b]);
  const std::uint32_t* const list = others_.data();
  return std::binary_search(list + first_[b], list + first_[b + 1], a);
}

void require_nothing_ignored(const Scene& scene, const std::string& who) {
  if (scene.ignored.empty()) return;
  throw Error(scene.name, "the scene ignores pairs of objects, and " + who + " answers about all",
              "leave ignore out of the scene file");
}

std::uint64_t remove_ignored(const Scene& scene, std::span<const ObjectPair> ignored,
                             std::vector<TrianglePair>& pairs) {
  const IgnoredObjects is_ignored(scene, ignored);
  return is_ignored.any() ? std::erase_if(pairs, is_ignored) : 0;
}

}  // namespace farcull
