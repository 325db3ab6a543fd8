// Contestants that lie, for the tests of the runner. Each is right by farcull's exact predicates
// but for its own fault.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include <unistd.h>

#include "experiments/peers/contestant.h"
#include "verify/exact.h"

namespace farcull {
namespace {

bool truth(const SuitePair& pair) { return intersects(pair.a, pair.b); }

/// The first coordinate numbers the pairs of the tests.
int number_of(const SuitePair& pair) { return static_cast<int>(pair.a[0][0]); }

Contestant liar(const std::string& name, std::function<bool(const SuitePair&)> pair) {
  return {.card = {.name = name,
                   .library = "liar 1",
                   .call = "nothing",
                   .says = "the truth",
                   .use = "tests"},
          .pair = std::move(pair)};
}

std::vector<TrianglePair> all_pairs(const Scene& scene) {
  std::vector<TrianglePair> out;
  for_each_object_pair(scene, [&](const Object& a, const Object& b) {
    for (std::uint32_t i = 0; i < a.triangle_count; ++i) {
      for (std::uint32_t k = 0; k < b.triangle_count; ++k) {
        const std::uint32_t t = a.first_triangle + i, u = b.first_triangle + k;
        if (t < u && intersects(scene.corners(t), scene.corners(u))) out.push_back({t, u});
      }
    }
  });
  return out;
}

[[noreturn]] void hang() {
  for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
}

/// Touches what it takes, so that it is there.
[[noreturn]] void take_all_memory() {
  std::vector<std::vector<char>> all;
  for (;;) all.emplace_back(std::size_t{16} << 20, 'x');
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  Contestant honest = liar("honest", truth);
  honest.mesh = all_pairs;
  Contestant drops = liar(
      "drops", [](const SuitePair& pair) { return truth(pair) && number_of(pair) % 100 != 99; });
  drops.mesh = [](const Scene& scene) {
    std::vector<TrianglePair> found = all_pairs(scene), out;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (i % 100 != 99) out.push_back(found[i]);
    }
    return out;
  };
  return contest(argc, argv,
                 {honest, drops,
                  liar("crashes",
                       [](const SuitePair& pair) {
                         if (number_of(pair) % 100 == 99) std::raise(SIGSEGV);
                         return truth(pair);
                       }),
                  liar("asserts",
                       [](const SuitePair& pair) {
                         if (number_of(pair) == 7) {
                           std::fputs("liar.cpp: Assertion `honest' failed.\n", stderr);
                           std::abort();
                         }
                         return truth(pair);
                       }),
                  liar("hangs",
                       [](const SuitePair& pair) {
                         if (number_of(pair) == 150) hang();
                         return truth(pair);
                       }),
                  liar("takes-all-memory",
                       [](const SuitePair& pair) {
                         if (number_of(pair) == 33) take_all_memory();
                         return truth(pair);
                       }),
                  // Keeps what it takes: no pair of its own takes much.
                  liar("leaks",
                       [kept = std::vector<std::vector<char>>()](const SuitePair& pair) mutable {
                         kept.emplace_back(std::size_t{4} << 20, 'x');
                         return truth(pair);
                       }),
                  liar("differs",
                       [asked = 0](const SuitePair& pair) mutable {
                         // Right on every question of the first process, wrong on the first of a
                         // later one.
                         return ++asked == 1 && number_of(pair) != 0 ? !truth(pair) : truth(pair);
                       }),
                  liar("leaves",
                       [](const SuitePair& pair) {
                         if (number_of(pair) == 120) std::_Exit(0);
                         return truth(pair);
                       }),
                  liar("refuses",
                       [](const SuitePair& pair) {
                         if (number_of(pair) % 10 == 3) throw Refusal("not this one");
                         return truth(pair);
                       }),
                  liar("blind", [](const SuitePair&) { return false; }),
                  liar("talks", [](const SuitePair& pair) {
                    std::printf("talk\n");  // goes to standard error, and does no harm
                    std::fflush(stdout);
                    return truth(pair);
                  })});
}
