#include "experiments/method/untested.h"

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {

void require_asked(std::uint64_t objects, bool self, std::uint64_t ignored,
                   const std::string& where, const std::string& otherwise) {
  const std::uint64_t pairs = objects * (objects - 1) / 2;
  if (objects < 2 || self || ignored < pairs) return;
  throw Error(where,
              "nothing to test: all " + counted(pairs, "pair", "pairs") + " of objects are ignored",
              otherwise.empty() ? "ignore fewer pairs" : "ignore fewer pairs, or " + otherwise);
}

void require_asked(const Scene& scene, std::vector<ObjectPair> ignored, const std::string& where,
                   const std::string& otherwise) {
  ignored.insert(ignored.end(), scene.ignored.begin(), scene.ignored.end());
  require_asked(scene.objects.size(), has_self(scene), in_order(std::move(ignored)).size(), where,
                otherwise);
}

}  // namespace farcull
