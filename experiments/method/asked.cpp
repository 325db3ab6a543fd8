#include "experiments/method/asked.h"

#include <cstdint>

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {

void require_asked(const Scene& scene, std::vector<ObjectPair> ignored, const std::string& where,
                   const std::string& otherwise) {
  ignored.insert(ignored.end(), scene.ignored.begin(), scene.ignored.end());
  const std::uint64_t count = scene.objects.size(), pairs = count * (count - 1) / 2;
  if (count < 2 || has_self(scene) || in_order(std::move(ignored)).size() < pairs) return;
  throw Error(where,
              "nothing to test: all " + counted(pairs, "pair", "pairs") + " of objects are ignored",
              otherwise.empty() ? "ignore fewer pairs" : "ignore fewer pairs, or " + otherwise);
}

}  // namespace farcull
