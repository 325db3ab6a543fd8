// The method `exact`: core's join finds pairs with overlapping boxes, and the thread that finds a
// pair decides it. No other file in verify/ uses core's join. Accounting and certificates check the
// results, so they find the pairs with overlapping boxes by their own trees.
#include <algorithm>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/boxes/block.h"
#include "core/boxes/join.h"
#include "core/scene/pair_sort.h"
#include "core/scene/scene.h"
#include "verify/exact.h"
#include "verify/within.h"

namespace farcull {
namespace {

// True if the closed boxes of the triangles are more than the clearance D apart along an axis,
// computed by differences in double. Rounding is monotone: if a rounded difference is above D, so
// is the exact difference. The join finds all pairs for which this function is false: the join
// grows each box by at least D/2 + ulp(D)/2. If the grown boxes are disjoint, an exact difference
// is above D + ulp(D), so the rounded difference is above D.
bool farther_along_an_axis(const Scene& scene, const TrianglePair& pair, double clearance) {
  const Box a = grown_box(scene, pair.a, 0), b = grown_box(scene, pair.b, 0);
  for (int k = 0; k < 3; ++k) {
    if (b.lo[k] - a.hi[k] > clearance || a.lo[k] - b.hi[k] > clearance) return true;
  }
  return false;
}

}  // namespace

ExactResult all_colliding_pairs(const Scene& scene, const ExactQuestion& question,
                                std::span<const ObjectPair> ignored) {
  const FloatingPointGuard guard;
  require_clearance("all_colliding_pairs", question.clearance);
  const Stopwatch watch;
  std::optional<IgnoredObjects> is_ignored;
  if (!ignored.empty()) is_ignored.emplace(scene, ignored);
  const unsigned threads = std::max(question.threads, 1u);
  ExactQuestion of_a_thread = question;
  of_a_thread.threads = 1;
  ExactResult result;
  GatheredPairs pairs, neighbour_pairs;
  std::set<std::thread::id> deciding;
  std::mutex mutex;  // guards result, pairs, neighbour_pairs and deciding
  OrderedPairs(scene, question.clearance, {}, true, threads)
      .give([&](std::vector<TrianglePair>& some) {
        if (question.clearance > 0) {
          std::erase_if(some, [&](const TrianglePair& pair) {
            return farther_along_an_axis(scene, pair, question.clearance);
          });
        }
        const std::uint64_t removed = is_ignored ? std::erase_if(some, std::cref(*is_ignored)) : 0;
        const Stopwatch start;
        Collisions decided = decide(scene, some, of_a_thread);
        const std::scoped_lock lock(mutex);
        pairs.add(std::exchange(decided.pairs, {}));
        neighbour_pairs.add(std::exchange(decided.neighbour_pairs, {}));
        result.append(decided);
        result.box_pairs += some.size();
        result.ignored += removed;
        result.predicates_ms += start.ms();
        deciding.insert(std::this_thread::get_id());
      });
  if (deciding.size() > 1) result.predicates_ms /= static_cast<double>(deciding.size());
  result.join_ms = watch.ms() - result.predicates_ms;
  const Stopwatch sorting;
  result.pairs = std::move(pairs).sorted(threads);
  result.neighbour_pairs = std::move(neighbour_pairs).sorted(threads);
  result.predicates_ms += sorting.ms();
  return result;
}

}  // namespace farcull
