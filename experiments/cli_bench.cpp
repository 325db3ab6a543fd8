#include "experiments/cli_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "experiments/bench_machine.h"
#include "experiments/builtin_scenes.h"
#include "experiments/output.h"
#include "experiments/run.h"
#include "experiments/scene_file.h"

namespace farcull {
namespace {

template <class Value>
Value parse_number(const char* option, const std::string& text, Value least, Value most,
                   const std::string& remedy) {
  Value value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !(value >= least) ||
      !(value <= most)) {
    throw Error(option, "'" + text + "' is none", remedy);
  }
  return value;
}

std::string peers_text() {
  std::string with = "Peers here:";
  std::string without;
  std::size_t column = with.size();
  for (const Peer& peer : all_peers(usable_cores())) {
    if (!peer.missing.empty()) {
      without += "Left out: " + peer.name + ": " + peer.missing + ".\n";
      continue;
    }
    const bool wraps = column + peer.name.size() > 90;
    column = wraps ? 2 + peer.name.size() : column + 1 + peer.name.size();
    with += (wraps ? "\n  " : " ") + peer.name;
  }
  return with + "\n" + without;
}

}  // namespace

CLI::App* BenchCommand::add_to(CLI::App& app, const char* scene_help) {
  CLI::App* command =
      app.add_subcommand("bench", "times beside other libraries, from triangles to pairs");
  command->add_option("SCENE", scene_, scene_help)->required()->type_name("");
  const auto add = [&](const char* name, Text& text, const char* type, const char* help) {
    command->add_option(name, text, help)->type_name(type);
  };
  command
      ->add_flag("--self", self_,
                 "every object is tested against itself as well, but\n"
                 "for triangles that share a vertex position")
      ->disable_flag_override();
  add("--peers", peers_, "LIST", "all, none, or names by commas; default all");
  add("--methods", methods_, "LIST", "of far-pairs,far,exact; all or none; default all");
  add("--threads", threads_, "N", "cores for each of them; default all there are");
  add("--repeat", repeat_, "N", "runs of each after a cold one; default 5");
  add("--limit", limit_, "SECONDS",
      "who takes longer in the cold run is not repeated;\ndefault 60");
  add("--device", device_, "DEVICE",
      "for methods on GL, as for farcull run, or cpu for\nnone of them; default where there is "
      "one");
  add("--json", outputs_.json, "FILE", kJsonHelp);
  command->footer([] {
    return "Examples:\n"
           "  farcull bench two-bunnies\n"
           "  farcull bench needles-layers --threads 1 --peers fcl-obbrss,embree-low\n"
           "  farcull bench field:1000000 --peers none --methods far-pairs --json field.json\n\n" +
           peers_text() +
           "docs/bench.md says what is measured. Exit status 1: two of them disagree about a pair.";
  });
  return command;
}

BenchOptions BenchCommand::parse() const {
  BenchOptions options;
  if (peers_) options.peers = *peers_;
  if (methods_) options.methods = *methods_;
  options.threads = usable_cores();
  if (threads_) {
    options.threads =
        parse_number<unsigned>("--threads", *threads_, 1, 1 << 16, "give a number from 1");
  }
  if (repeat_)
    options.repeat = parse_number<int>("--repeat", *repeat_, 1, 1'000'000, "give 1 or more");
  if (limit_) {
    options.limit_s = parse_number<double>("--limit", *limit_, 0, 1e9, "give seconds, 0 to 1e9");
  }
  options.device = device_of(device_);
  options.self = self_;
  options.seed = scene_.size() == 1 ? builtin_seed(scene_[0]) : std::nullopt;
  validate(options);
  if (options.device != "cpu") {
    RunOptions run;
    run.device = options.device;
    validate(run);
  }
  return options;
}

int BenchCommand::run() {
  const BenchOptions options = parse();
  if (std::find(scene_.begin(), scene_.end(), "") != scene_.end())
    throw Error("SCENE", "a name is empty", "name mesh files, a scene file or a built-in scene");
  const Outputs outputs = checked(outputs_, scene_files(scene_));
  confine_to_cores(options.threads);
  TerminalProgress terminal;
  const Progress progress = terminal.callback();
  if (progress) progress("reading the scene");
  Scene scene = load_scene(scene_);
  if (options.self) {
    for (Object& object : scene.objects) object.self = true;
  }
  const BenchResult result = bench(scene, contestants(scene, options, progress), options, progress);
  terminal.clear();
  if (outputs.json) write_json(to_json(scene, options, result), *outputs.json);
  if (!outputs.to_stdout()) write_output("-", bench_table(scene, options, result));
  if (!result.disagreement) return 0;
  complain(describe(scene, *result.disagreement));
  return 1;
}

}  // namespace farcull
