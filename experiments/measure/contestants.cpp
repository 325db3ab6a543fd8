// Who takes part in a benchmark: methods by the one pipeline, peers by their own set-up.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "experiments/measure/bench.h"
#include "experiments/method/run.h"
#include "experiments/peers/parts.h"
#include "offsets/obb.h"

namespace farcull {
namespace {

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

// Neighbours are not asked for: the peers leave them out too.
BenchRun method_run(Method method, std::shared_ptr<Session> session, const std::string& device) {
  RunOptions options{.method = method, .verify = false, .neighbours = false};
  options.device = device;
  return [=](const Scene& scene) {
    const Stopwatch watch;
    Record record = run(scene, options, *session, {}, {.answer_only = true});
    return BenchAnswer{.candidates_ms = watch.ms() - record.ms.exact,
                       .exact_ms = record.ms.exact,
                       .candidate_pairs = record.found.count,
                       .pairs = std::move(record.collisions.pairs)};
  };
}

/// Sets up one contestant. What cannot run is left out, or an Error where it was asked for by name.
class ContestantList {
 public:
  explicit ContestantList(const Progress& progress) : progress_(progress) {}

  template <class SetUp>
  void add(BenchContestant contestant, bool by_name, const char* option, const SetUp& set_up) {
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

  std::vector<BenchContestant> all;

 private:
  const Progress& progress_;
};

void add_methods(const Scene& scene, const BenchOptions& options, ContestantList& list) {
  const bool by_name = options.methods != "all";
  const bool no_gl = is_cpu(options.device);
  // Without --device, drawing on GL is measured where hardware answers, and far-pairs where any
  // does.
  const bool gl_by_name = by_name && !options.device.empty();
  const std::string gl_device = options.device.empty() ? "gl" : options.device;
  std::shared_ptr<Session> gl;  // that the methods share
  const auto on_gl = [&](BenchContestant& c, Method method) {
    if (!gl) gl = std::make_shared<Session>(gl_device, options.threads);
    c.device = gl->context().info().renderer;
    c.run = method_run(method, gl, gl_device);
  };
  for (const std::string& name : chosen("--methods", options.methods, kMethods)) {
    const Method method = parse_method(name);
    const std::string refused =
        has_self(scene) && !tests_self(method) ? "it tests no object against itself" : "";
    list.add({.name = name, .left_out = refused}, by_name, "--methods", [&](BenchContestant& c) {
      c.run = method_run(method, std::make_shared<Session>("native", options.threads), "native");
    });
    const bool slow = draws(method) && options.device.empty() && !GlContext::hardware_listed();
    if (!looks(method) || no_gl || slow) continue;
    list.add({.name = name, .device = "gl", .left_out = refused}, gl_by_name, "--methods",
             [&](BenchContestant& c) {
               on_gl(c, method);
               if (draws(method)) {
                 gl->canvas(obb_fattener(), {});
               } else {
                 gl->pairs();
               }
             });
  }
}

void add_peers(const Scene& scene, const BenchOptions& options, ContestantList& list) {
  const std::vector<Peer> peers = all_peers(options.threads);
  const std::vector<std::string> names = chosen("--peers", options.peers, names_of(peers));
  const bool by_name = options.peers != "all";
  for (const Peer& peer : peers) {
    if (std::find(names.begin(), names.end(), peer.name) == names.end()) continue;
    BenchContestant contestant{.name = peer.name, .peer = true, .library = peer.library};
    contestant.left_out = peer.missing;
    if (contestant.left_out.empty() && peer.refuses) contestant.left_out = peer.refuses(scene);
    list.add(contestant, by_name, "--peers",
             [&](BenchContestant& c) { c.run = peer.set_up(options.threads); });
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

std::vector<BenchContestant> contestants(const Scene& scene, const BenchOptions& options,
                                         const Progress& progress) {
  ContestantList list(progress);
  add_methods(scene, options, list);
  add_peers(scene, options, list);
  return std::move(list.all);
}

}  // namespace farcull
