// Distances of full scenes against the truth in rational numbers: a part of
// experiments/reliability.sh distances. Prints a row of a table for each question, and exits with 1
// if an answer is wrong.
//   farcull_distance_reliability SCENE DIAGONALS [bit|pair]
// SCENE: a built-in one; DIAGONALS: by so many the second half of its objects is moved. bit, pair:
// spoils the answers, which must be noticed: a distance by one bit, or a nearest pair is dropped.
#include <cinttypes>

#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/experiments/method/distance_truth.h"

namespace farcull {
namespace {

using distance_lab::Q, distance_truth::Nearest;
using enum DistancePairs;

enum class Spoil : std::uint8_t { nothing, bit, pair };

// Where there are more pairs of objects than these, each object asks for its nearest one alone.
constexpr std::size_t kMostQuestions = 5'000;

struct Row {
  std::uint64_t answers = 0, unequal = 0, nearest = 0, missed = 0, computed = 0;
  bool holds() const { return unequal == 0 && missed == 0; }
};

double next(double x) { return std::nextafter(x, HUGE_VAL); }

/// Whether the answer is that of the truth, bit for bit.
bool equal(const Distance& answer, const ObjectPair& objects, const Nearest& truth) {
  return answer.objects == objects && answer.triangles == truth.pairs.front() &&
         Q(answer.closest.squared.text()) == truth.squared &&
         closest_reference::is_rounded_root(answer.closest.distance, truth.squared);
}

// Compares what was answered about two objects, and what was left to exact arithmetic.
void compare(const Nearest& truth, const ObjectPair& objects, const Distance* answer,
             const NearPairs* near, Row& row) {
  ++row.answers;
  row.unequal += answer == nullptr || !equal(*answer, objects, truth);
  row.nearest += truth.pairs.size();
  for (const TrianglePair& pair : truth.pairs)
    row.missed += near == nullptr || !std::ranges::binary_search(near->pairs, pair);
}

void spoil_first(Spoil spoil, const ObjectPair& objects, const Nearest& truth,
                 DistanceRecord& record, std::vector<NearPairs>& near) {
  for (Distance& d : record.distances)
    if (spoil == Spoil::bit && d.objects == objects) d.closest.distance = next(d.closest.distance);
  for (NearPairs& of : near)
    if (spoil == Spoil::pair && of.objects == objects) std::erase(of.pairs, truth.pairs.front());
}

Row run_scene(const Scene& scene, DistancePairs pairs, Spoil spoil) {
  DistanceRecord record = distances(scene, {.pairs = pairs, .inside = false});
  const ProximityTrees trees(scene);
  const double far = std::numeric_limits<double>::infinity();
  distance_truth::Truth truth(scene);
  std::vector<Nearest> expected;
  std::vector<NearPairs> near;
  if (pairs == nearest) {
    near = trees.nearest_objects(1, far);
    expected = truth.nearest_of_each();
  } else {
    std::vector<ObjectPair> questions;
    const auto count = static_cast<std::uint32_t>(scene.objects.size());
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = a; b < count; ++b) {
        if (a == b && !scene.objects[a].self) continue;
        questions.push_back({a, b});
        if (auto found = truth.nearest({a, b})) expected.push_back(std::move(*found));
      }
    }
    near = trees.near_pairs(questions, far, {});
  }
  Row out{.computed = truth.computed()};
  const auto objects_of = [](const Nearest& n) {
    return ObjectPair{std::min(n.objects.a, n.objects.b), std::max(n.objects.a, n.objects.b)};
  };
  if (!expected.empty())
    spoil_first(spoil, objects_of(expected.front()), expected.front(), record, near);
  std::vector<const Distance*> answer_of(scene.objects.size());  // with `nearest`
  for (const NearestOfObject& of : nearest_of_objects(scene, record.distances, 1))
    if (!of.distances.empty()) answer_of[of.object] = &record.distances[of.distances[0]];
  for (const Nearest& n : expected) {
    const ObjectPair objects = objects_of(n);
    const Distance* answer = answer_of[n.objects.a];
    if (pairs != nearest) {
      const auto found =
          std::ranges::lower_bound(record.distances, objects, {}, &Distance::objects);
      answer = found == record.distances.end() ? nullptr : &*found;
    }
    const auto found = std::ranges::lower_bound(near, objects, {}, &NearPairs::objects);
    const bool there = found != near.end() && found->objects == objects;
    compare(n, objects, answer, there ? &*found : nullptr, out);
  }
  if (pairs == objects && record.distances.size() != expected.size()) ++out.unequal;
  return out;
}

void print(const std::string& scene, const std::string& moved, const char* question, const Row& row,
           double ms) {
  std::printf("| %s | %s | %s | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " | %" PRIu64
              " | %.1f |\n",
              scene.c_str(), moved.c_str(), question, row.answers, row.unequal, row.nearest,
              row.missed, row.computed, ms / 1000);
  std::fflush(stdout);
  if (row.holds()) return;
  std::fprintf(stderr, "wrong: %" PRIu64 " answers, and %" PRIu64 " nearest pairs missed\n",
               row.unequal, row.missed);
}

bool run_built_in(const std::string& name, const std::string& diagonals, Spoil spoil) {
  Scene scene = make_builtin_scene(name);
  const bool single = scene.objects.size() == 1;
  if (single) scene.objects[0].self = true;
  scene = distance_lab::moved_apart(std::move(scene), std::stod(diagonals));
  const std::size_t n = scene.objects.size();
  bool holds = true;
  for (const DistancePairs pairs : {objects, nearest}) {
    if (pairs == objects ? n * (n - 1) / 2 > kMostQuestions : n <= 2) continue;
    const Stopwatch watch;
    const Row row = run_scene(scene, pairs, spoil);
    print(name, diagonals,
          single             ? "itself"
          : pairs == objects ? "objects"
                             : "nearest",
          row, watch.ms());
    holds &= row.holds();
  }
  return holds;
}

int run(const std::vector<std::string>& words) {
  const auto diagonals = words.size() < 2 ? std::nullopt : parse_number<double>(words[1]);
  const bool spoils = words.size() == 3 && (words[2] == "bit" || words[2] == "pair");
  if (!diagonals || !(*diagonals >= 0) || words.size() != (spoils ? 3u : 2u)) {
    std::fprintf(stderr, "farcull_distance_reliability SCENE DIAGONALS [bit|pair]\n");
    return 2;
  }
  const FloatingPointGuard guard;
  const Spoil spoil = !spoils ? Spoil::nothing : words[2] == "bit" ? Spoil::bit : Spoil::pair;
  return run_built_in(words[0], words[1], spoil) ? 0 : 1;
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  try {
    return farcull::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "farcull_distance_reliability: %s\n", error.what());
    return 2;
  }
}
