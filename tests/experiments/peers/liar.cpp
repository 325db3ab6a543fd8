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

std::array<Vec3, 3> corners(const ContestTriangle& t) {
  return {Vec3(t[0].data()), Vec3(t[1].data()), Vec3(t[2].data())};
}

bool truth(const ContestPair& pair) {
  return intersects(corners(pair.triangles[0]), corners(pair.triangles[1]));
}

/// The first coordinate numbers the pairs of the tests.
int number_of(const ContestPair& pair) { return static_cast<int>(pair.triangles[0][0][0]); }

Contestant liar(const std::string& name, std::function<bool(const ContestPair&)> pair) {
  return {.card = {.name = name,
                   .library = "liar 1",
                   .call = "nothing",
                   .says = "the truth",
                   .use = "tests"},
          .pair = std::move(pair)};
}

std::vector<ContestFound> all_pairs(const ContestScene& scene) {
  std::vector<ContestFound> out;
  for_each_object_pair(scene, [&](std::uint32_t a, std::uint32_t b) {
    for (std::uint32_t t = 0; t < scene.objects[a].triangles.size(); ++t) {
      for (std::uint32_t u = 0; u < scene.objects[b].triangles.size(); ++u) {
        if ((a != b || t < u) &&
            truth({{scene.objects[a].corners(t), scene.objects[b].corners(u)}, {}}))
          out.push_back({a, t, b, u});
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
      "drops", [](const ContestPair& pair) { return truth(pair) && number_of(pair) % 100 != 99; });
  drops.mesh = [](const ContestScene& scene) {
    std::vector<ContestFound> found = all_pairs(scene), out;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (i % 100 != 99) out.push_back(found[i]);
    }
    return out;
  };
  return contest(argc, argv,
                 {honest, drops,
                  liar("crashes",
                       [](const ContestPair& pair) {
                         if (number_of(pair) % 100 == 99) std::raise(SIGSEGV);
                         return truth(pair);
                       }),
                  liar("asserts",
                       [](const ContestPair& pair) {
                         if (number_of(pair) == 7) {
                           std::fputs("liar.cpp: Assertion `honest' failed.\n", stderr);
                           std::abort();
                         }
                         return truth(pair);
                       }),
                  liar("hangs",
                       [](const ContestPair& pair) {
                         if (number_of(pair) == 150) hang();
                         return truth(pair);
                       }),
                  liar("takes-all-memory",
                       [](const ContestPair& pair) {
                         if (number_of(pair) == 33) take_all_memory();
                         return truth(pair);
                       }),
                  // Keeps what it takes: no pair of its own takes much.
                  liar("leaks",
                       [kept = std::vector<std::vector<char>>()](const ContestPair& pair) mutable {
                         kept.emplace_back(std::size_t{4} << 20, 'x');
                         return truth(pair);
                       }),
                  liar("differs",
                       [asked = 0](const ContestPair& pair) mutable {
                         // Right on every question of the first process, wrong on the first of a
                         // later one.
                         return ++asked == 1 && number_of(pair) != 0 ? !truth(pair) : truth(pair);
                       }),
                  liar("leaves",
                       [](const ContestPair& pair) {
                         if (number_of(pair) == 120) std::_Exit(0);
                         return truth(pair);
                       }),
                  liar("refuses",
                       [](const ContestPair& pair) {
                         if (number_of(pair) % 10 == 3) throw Refusal("not this one");
                         return truth(pair);
                       }),
                  liar("blind", [](const ContestPair&) { return false; }),
                  liar("talks", [](const ContestPair& pair) {
                    std::printf("talk\n");  // goes to standard error, and does no harm
                    std::fflush(stdout);
                    return truth(pair);
                  })});
}
