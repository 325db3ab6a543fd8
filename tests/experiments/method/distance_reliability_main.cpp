// Distances of full scenes and of many small ones against the truth in rational numbers: a part of
// experiments/reliability.sh distances. Prints a row of a table for each question, and exits with 1
// if an answer is wrong.
//   farcull_distance_reliability SCENE DIAGONALS [bit|pair]
//   farcull_distance_reliability random FIRST COUNT [bit|pair]
// SCENE: a built-in one; DIAGONALS: by so many the second half of its objects is moved. random:
// COUNT small scenes, drawn with the seeds FIRST, FIRST + 1, ... bit, pair: spoils the answers,
// which must be noticed: a distance by one bit, or a nearest pair is dropped.
#include <unistd.h>

#include <cinttypes>

#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/experiments/method/distance_truth.h"

namespace farcull {
namespace {

using distance_lab::Answer;
using distance_lab::Q;
using distance_truth::Nearest;
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

/// Up to four objects of up to six triangles. By the seed: on a grid, where many pairs are as near
/// or meet; in a cube; of many magnitudes; on a grid and moved by some units in the last place.
Scene small_scene(std::uint64_t seed) {
  rational::Draws random(seed);
  Scene scene = distance_lab::random_scene(random, 2 + random.below(3), 6);
  const auto kind = seed % 4;
  if (kind == 0) return scene;
  for (Vec3& p : scene.vertices) {
    if (kind == 1) p = random.cube(1);
    if (kind == 2) p = random.scaled3(-40, 1);
    for (int k = 0; k < 3 && kind == 3; ++k)
      for (int steps = random.below(4); steps > 0; --steps)
        p[k] = std::nextafter(p[k], random.coin() ? 1e300 : -1e300);
  }
  return scene;
}

void run_small(std::uint64_t seed, Spoil spoil, Row& row) {
  const Scene scene = small_scene(seed);
  const distance_lab::Truth truth(scene);
  for (const DistanceOptions& options : {DistanceOptions{.pairs = objects, .inside = false},
                                         DistanceOptions{.pairs = nearest, .inside = false}}) {
    if (!nothing_asked(scene, options).empty()) continue;
    DistanceRecord record = distances(scene, options);
    if (spoil == Spoil::bit)
      record.distances[0].closest.distance = next(record.distances[0].closest.distance);
    if (spoil == Spoil::pair) record.distances.erase(record.distances.begin());
    const std::vector<Answer> answers = distance_lab::answers_of(record);
    const std::vector<Answer> expected = truth.answers(options);
    row.answers += expected.size();
    row.nearest += expected.size();
    for (const Answer& e : expected) {
      const auto found = std::ranges::lower_bound(answers, e.objects, {}, &Answer::objects);
      const bool there = found != answers.end() && found->objects == e.objects;
      row.missed += !there || found->pair != e.pair;
      row.unequal += !there || found->squared != e.squared;
    }
    row.unequal += answers.size() > expected.size() ? answers.size() - expected.size() : 0;
  }
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

bool run_random(std::uint64_t first, std::uint64_t count, Spoil spoil) {
  const bool terminal = isatty(2) == 1;
  const Stopwatch watch;
  Row row;
  for (std::uint64_t k = 0; k < count; ++k) {
    const bool held = row.holds();
    run_small(first + k, spoil, row);
    if (held && !row.holds())
      std::fprintf(stderr, "first wrong with the seed %" PRIu64 "\n", first + k);
    if (terminal && k % 100 == 99) std::fprintf(stderr, "\r%" PRIu64 " of %" PRIu64, k + 1, count);
  }
  if (terminal) std::fprintf(stderr, "\r\033[K");
  print("random, seeds " + std::to_string(first) + " to " + std::to_string(first + count - 1), "-",
        "objects, nearest", row, watch.ms());
  return row.holds();
}

int usage() {
  std::fprintf(stderr,
               "farcull_distance_reliability SCENE DIAGONALS [bit|pair]\n"
               "farcull_distance_reliability random FIRST COUNT [bit|pair]\n");
  return 2;
}

int run(const std::vector<std::string>& words) {
  const bool random = !words.empty() && words[0] == "random";
  const std::size_t needed = random ? 3 : 2;
  if (words.size() < needed || words.size() > needed + 1) return usage();
  Spoil spoil = Spoil::nothing;
  if (words.size() > needed) {
    if (words.back() != "bit" && words.back() != "pair") return usage();
    spoil = words.back() == "bit" ? Spoil::bit : Spoil::pair;
  }
  const FloatingPointGuard guard;
  if (!random) {
    const auto diagonals = parse_number<double>(words[1]);
    if (!diagonals || !(*diagonals >= 0)) return usage();
    return run_built_in(words[0], words[1], spoil) ? 0 : 1;
  }
  const auto first = parse_number<std::uint64_t>(words[1]);
  const auto count = parse_number<std::uint64_t>(words[2]);
  if (!first || !count || *count == 0) return usage();
  return run_random(*first, *count, spoil) ? 0 : 1;
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
