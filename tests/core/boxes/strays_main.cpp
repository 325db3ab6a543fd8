// Time and memory of boxes on scenes of strays (tests/lab/strays.h), against the
// method `exact` on the same scene: farcull_strays [SEEDS [FIRST]]. Each run has a process of its
// own. Fails where boxes takes more than three times as much, and a constant.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "experiments/method/run.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/system/machine.h"
#include "tests/lab/strays.h"

namespace farcull {
namespace {

constexpr double kTimes = 3, kMs = 30, kMib = 16;

struct Cost {
  double ms = -1, mib = -1;  // of all threads; above what the scene takes
  std::uint64_t colliding = 0;
};

double cpu_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

Cost cost_of(const Scene& scene, Method method) {
  RunOptions options;
  options.method = method;
  options.verify = false;
  const PeakMemory memory;
  const double start = cpu_ms();
  Session session("native");
  const Record record = run(scene, options, session);
  return {cpu_ms() - start, memory.grown_mib().value_or(0), record.collisions.all().size()};
}

// In a process of its own; ms stays negative where that one dies.
Cost measured(const std::function<Scene()>& scene, Method method) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    const Cost cost = cost_of(scene(), method);
    const bool written = write(ends[1], &cost, sizeof cost) == sizeof cost;
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  Cost out;
  if (read(ends[0], &out, sizeof out) != sizeof out) out = {};
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return out;
}

// Whether boxes keeps to what it may take.
bool row(const std::string& name, const std::function<Scene()>& scene) {
  const Cost exact = measured(scene, Method::exact), boxes = measured(scene, Method::boxes);
  const bool same = exact.ms >= 0 && boxes.ms >= 0 && exact.colliding == boxes.colliding;
  const bool kept =
      same && boxes.ms <= kTimes * exact.ms + kMs && boxes.mib <= kTimes * exact.mib + kMib;
  std::printf("| %s | %llu | %.0f | %.0f | %.2f | %.0f | %.0f |%s\n", name.c_str(),
              static_cast<unsigned long long>(exact.colliding), exact.ms, boxes.ms,
              boxes.ms / exact.ms, exact.mib, boxes.mib,
              kept   ? ""
              : same ? " too much"
                     : " WRONG");
  std::fflush(stdout);
  return kept;
}

// A built-in scene with a triangle of each object made `times` as large, or with a corner there.
Scene with_stray(const char* name, bool self, double times, bool corner) {
  Scene scene = make_builtin_scene(name);
  for (Object& object : scene.objects) {
    object.self = self;
    const auto& [a, b, c] = scene.triangles[object.first_triangle + object.triangle_count / 2];
    if (corner) {
      scene.vertices[a].x() = times;
      continue;
    }
    double size = 0;
    for (const Vec3& v : scene.vertices) size = std::max(size, v.cwiseAbs().maxCoeff());
    const Vec3 middle = scene.vertices[a];
    scene.vertices[b] = middle + times * size * Vec3(0.5, -0.3, 0.2);
    scene.vertices[c] = middle + times * size * Vec3(-0.2, 0.6, 0.4);
    scene.vertices[a] = middle + times * size * Vec3(-0.5, -0.4, -0.3);
  }
  return scene;
}

int main_of(int count, int first) {
  std::printf(
      "| scene | colliding | exact, ms | boxes, ms | ratio | exact, MiB | boxes, MiB "
      "|\n|---|---:|---:|---:|---:|---:|---:|\n");
  int too_much = 0;
  for (const char* name : {"bunny", "two-bunnies"}) {
    const bool self = std::string(name) == "bunny";
    const std::string what = std::string(name) + (self ? " --self" : "");
    if (first != 0) break;
    too_much += !row(what, [&] { return with_stray(name, self, 0, false); });
    for (const double times : {1e4, 3e4}) {
      char text[80];
      std::snprintf(text, sizeof text, "%s, a triangle of %g times its size", what.c_str(), times);
      too_much += !row(text, [&] { return with_stray(name, self, times, false); });
    }
    too_much +=
        !row(what + ", a corner at 1e30", [&] { return with_stray(name, self, 1e30, true); });
  }
  for (int seed = first; seed < first + count; ++seed) {
    const auto number = static_cast<std::uint64_t>(seed);
    const lab::Strays strays = lab::random_strays(number);
    char text[120];
    std::snprintf(text, sizeof text, "%d: %s, %d strays, %.0f decades%s%s", seed,
                  strays.surface ? "sheets" : "cube", strays.outliers, strays.decades,
                  strays.spread ? ", places too" : "", strays.self ? ", with itself" : "");
    too_much += !row(text, [&] { return lab::stray_scene(number, 20'000, strays); });
  }
  std::printf("boxes took too much, or was wrong, in %d scenes\n", too_much);
  return too_much > 0 ? 1 : 0;
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  return farcull::main_of(argc > 1 ? std::atoi(argv[1]) : 100, argc > 2 ? std::atoi(argv[2]) : 0);
}
