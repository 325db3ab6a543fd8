#include <cstdlib>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/box_join.h"
#include "core/cull.h"
#include "core/error.h"
#include "core/gl_canvas.h"
#include "core/gl_context.h"
#include "core/gl_pairs.h"
#include "core/pairs.h"
#include "core/pairs_cpu.h"
#include "core/plan.h"
#include "core/view.h"
#include "experiments/bench.h"
#include "experiments/peer_parts.h"
#include "offsets/obb.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr int kFarResolution = 512;  // what farcull run takes
constexpr const char* kFarViews = "x,y,z";
const std::vector<std::string> kMethods = {"far-pairs", "far", "exact"};

std::vector<std::string> names_of(const std::vector<Peer>& peers) {
  std::vector<std::string> names;
  for (const Peer& peer : peers) names.push_back(peer.name);
  return names;
}

/// Those of `known` that the text asks for, in their order. Throws Error naming the option.
std::vector<std::string> chosen(const std::string& option, const std::string& text,
                                const std::vector<std::string>& known) {
  if (text == "all") return known;
  if (text == "none") return {};
  const std::vector<std::string> asked = split_list(text);
  for (const std::string& name : asked) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw Error(option, "'" + name + "' is none of them",
                fmt::format("give all, none, or some of {}", fmt::join(known, ",")));
  }
  std::vector<std::string> out;
  for (const std::string& name : known) {
    if (std::find(asked.begin(), asked.end(), name) != asked.end()) out.push_back(name);
  }
  return out;
}

BenchAnswer decided(const Scene& scene, std::vector<TrianglePair> candidates, double candidates_ms,
                    unsigned threads) {
  const Stopwatch exact;
  const ExactQuestion question{.threads = threads, .neighbours = false};
  BenchAnswer answer{.candidates_ms = candidates_ms, .candidate_pairs = candidates.size()};
  answer.pairs = decide(scene, candidates, question).pairs;
  answer.exact_ms = exact.ms();
  return answer;
}

BenchRun far_pairs(std::shared_ptr<PairBackend> backend, unsigned threads) {
  return [=](const Scene& scene) {
    const Stopwatch watch;
    const PairSettings settings{.views = {}, .neighbours = false};
    PairResult result = find_pairs(scene, settings, *backend);
    return decided(scene, std::move(result.candidates), watch.ms(), threads);
  };
}

BenchRun far(std::shared_ptr<GlCanvas> canvas, unsigned threads) {
  return [=](const Scene& scene) {
    const Stopwatch watch;
    const Plan plan = make_plan(scene);
    std::vector<std::uint32_t> live;
    if (!plan.triangles.empty()) {
      const CullSettings settings{.views = parse_views(kFarViews),
                                  .resolution = kFarResolution,
                                  .fattener = obb_fattener(),
                                  .radius = {}};
      live = cull(scene, plan, settings, *canvas).live;
    }
    std::vector<TrianglePair> candidates = box_join(plan.triangle_boxes, owners(scene), live);
    return decided(scene, std::move(candidates), watch.ms(), threads);
  };
}

BenchRun exact(unsigned threads) {
  return [=](const Scene& scene) {
    const ExactQuestion question{.threads = threads, .neighbours = false};
    ExactResult result = all_colliding_pairs(scene, question);
    return BenchAnswer{.candidates_ms = result.join_ms,
                       .exact_ms = result.predicates_ms,
                       .candidate_pairs = result.box_pairs,
                       .pairs = std::move(result.pairs)};
  };
}

/// The context that the GL methods share, opened when first needed. With llvmpipe, the device that
/// there is without a GPU, rasterizing takes its threads from the environment.
class SharedContext {
 public:
  explicit SharedContext(const BenchOptions& options) : options_(options) {}

  std::shared_ptr<GlContext> get() {
    if (!context_) {
      ::setenv("LP_NUM_THREADS", std::to_string(options_.threads).c_str(), 1);
      context_ = std::make_shared<GlContext>(options_.device);
    }
    return context_;
  }

 private:
  const BenchOptions& options_;
  std::shared_ptr<GlContext> context_;
};

/// Owned together with the context that it must not outlive.
template <class Made>
std::shared_ptr<Made> beside(std::shared_ptr<GlContext> context, std::unique_ptr<Made> made) {
  Made* const raw = made.release();
  return std::shared_ptr<Made>(raw, [context = std::move(context)](Made* old) { delete old; });
}

/// Sets up one contestant. What cannot run is left out, or an Error where it was asked for by name.
class Gathering {
 public:
  explicit Gathering(const Progress& progress) : progress_(progress) {}

  template <class SetUp>
  void add(Contestant contestant, bool by_name, const char* option, const SetUp& set_up) {
    if (progress_) progress_("setting up " + contestant.name);
    if (contestant.left_out.empty()) {
      const Stopwatch watch;
      try {
        set_up(contestant);
      } catch (const Error& error) {
        if (by_name) throw;
        contestant.left_out = error.where + ": " + error.reason;
      }
      contestant.setup_ms = watch.ms();
    } else if (by_name) {
      throw Error(option, contestant.name + ": " + contestant.left_out, "leave it out");
    }
    all.push_back(std::move(contestant));
  }

  std::vector<Contestant> all;

 private:
  const Progress& progress_;
};

void add_methods(const Scene& scene, const BenchOptions& options, Gathering& gathering) {
  const unsigned threads = options.threads;
  const bool self = std::any_of(scene.objects.begin(), scene.objects.end(),
                                [](const Object& object) { return object.self; });
  const bool by_name = options.methods != "all";
  const bool no_gl = options.device == "cpu";
  // Without --device, GL is measured where there is one.
  const bool gl_by_name = by_name && !options.device.empty();
  SharedContext context(options);
  for (const std::string& method : chosen("--methods", options.methods, kMethods)) {
    if (method == "far-pairs") {
      gathering.add({.name = method}, by_name, "--methods",
                    [&](Contestant& c) { c.run = far_pairs(cpu_pair_backend(threads), threads); });
      if (no_gl) continue;
      gathering.add({.name = method, .device = "gl"}, gl_by_name, "--methods", [&](Contestant& c) {
        const std::shared_ptr<GlContext> gl = context.get();
        c.device = gl->info().renderer;
        c.run = far_pairs(beside(gl, gl_pair_backend(*gl)), threads);
      });
    } else if (method == "far") {
      Contestant contestant{.name = method, .device = "gl"};
      if (self) contestant.left_out = "it tests no object against itself";
      if (no_gl) contestant.left_out = "it needs a GL device, and --device is cpu";
      gathering.add(contestant, by_name, "--methods", [&](Contestant& c) {
        const std::shared_ptr<GlContext> gl = context.get();
        const Fattener fattener = obb_fattener();
        c.device = gl->info().renderer;
        c.run = far(beside(gl, std::make_unique<GlCanvas>(*gl, fattener.mode, fattener.solid)),
                    threads);
      });
    } else {
      gathering.add({.name = method}, by_name, "--methods",
                    [&](Contestant& c) { c.run = exact(threads); });
    }
  }
}

void add_peers(const Scene& scene, const BenchOptions& options, Gathering& gathering) {
  const std::vector<Peer> peers = all_peers(options.threads);
  const std::vector<std::string> names = chosen("--peers", options.peers, names_of(peers));
  const bool by_name = options.peers != "all";
  for (const Peer& peer : peers) {
    if (std::find(names.begin(), names.end(), peer.name) == names.end()) continue;
    Contestant contestant{.name = peer.name, .peer = true, .library = peer.library};
    contestant.left_out = peer.missing;
    if (contestant.left_out.empty() && peer.refuses) contestant.left_out = peer.refuses(scene);
    gathering.add(contestant, by_name, "--peers",
                  [&](Contestant& c) { c.run = peer.set_up(options.threads); });
  }
}

}  // namespace

void validate(const BenchOptions& options) {
  chosen("--methods", options.methods, kMethods);
  chosen("--peers", options.peers, names_of(all_peers(options.threads)));
  if (options.repeat < 1) {
    throw Error("--repeat", fmt::format("{} is no number of runs", options.repeat),
                "give 1 or more");
  }
  if (!(options.limit_s >= 0)) {
    throw Error("--limit", fmt::format("{} is no time", options.limit_s),
                "give seconds, 0 or more");
  }
  if (options.methods == "none" && options.peers == "none") {
    throw Error("--peers", "nobody is left to be measured", "name a peer or a method");
  }
}

std::vector<Contestant> contestants(const Scene& scene, const BenchOptions& options,
                                    const Progress& progress) {
  Gathering gathering(progress);
  add_methods(scene, options, gathering);
  add_peers(scene, options, gathering);
  return std::move(gathering.all);
}

}  // namespace farcull
