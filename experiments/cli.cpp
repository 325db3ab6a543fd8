#include "experiments/cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <utility>

#include "commit.h"
#include "core/error.h"
#include "core/floating_point.h"
#include "experiments/check.h"
#include "experiments/cli_bench.h"
#include "experiments/cli_experiment.h"
#include "experiments/cli_parts.h"
#include "experiments/cli_picture.h"
#include "experiments/cli_report.h"
#include "experiments/cli_run.h"
#include "experiments/cli_scenes.h"
#include "experiments/cli_studies.h"
#include "experiments/compare.h"
#include "experiments/doctor.h"
#include "experiments/output.h"
#include "experiments/scene_file.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

constexpr int kDone = 0, kBroken = 1, kBad = 2;

constexpr const char* kOutOfMemory =
    "memory: there is not enough; use a smaller scene or resolution, a higher limit (ulimit -v) or "
    "a machine with more memory";

std::string fault(const std::exception& error) {
  return std::string("a fault of farcull itself: ") + error.what() +
         "; report it with the command line";
}

struct CompareCommand {
  CompareArguments arguments;
  Text device, views, clearance;
  Outputs outputs;
};

int compare_command(const CompareCommand& command) {
  CompareArguments arguments = command.arguments;
  arguments.options.device = device_of(command.device);
  arguments.options.seed = seed_of(arguments.scene);
  if (command.views) {
    const bool pairs =
        !arguments.methods || arguments.methods->find("far-pairs") != std::string::npos;
    arguments.options.views = parse_views_option(*command.views, pairs);
  }
  if (command.clearance) arguments.options.clearance = parse_clearance(*command.clearance);
  validate(arguments);
  check_scene(arguments.scene);
  const Outputs outputs = checked(command.outputs, scene_files(arguments.scene));
  TerminalProgress terminal;
  const Progress progress = terminal.callback();
  if (progress) progress("reading the scene");
  Scene scene = load_scene(arguments.scene);
  if (arguments.self) make_self(scene);
  const Comparison comparison = compare(scene, arguments, progress);
  terminal.clear();
  const std::vector<RunRecord> records = comparison.median_records();
  if (outputs.json) write_json(to_json(scene, comparison), *outputs.json);
  if (!outputs.to_stdout()) write_output("-", comparison_table(scene, records));
  for (const RunRecord& record : records) {
    if (!broken(record, false)) continue;
    complain(missed(record));
    return kBroken;
  }
  return kDone;
}

// What CLI11 refuses, as an Error with a remedy. `app` is as the parse left it.
Error refusal(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = &app;
  std::string name = "farcull";
  for (bool deeper = true; deeper;) {
    deeper = false;
    for (const CLI::App* subcommand : command->get_subcommands({})) {
      if (!subcommand->parsed()) continue;
      command = subcommand;
      name += " " + command->get_name();
      deeper = true;
      break;
    }
  }
  const std::vector<const CLI::App*> subcommands = command->get_subcommands({});
  const std::string help = "see " + name + " --help";
  const std::string text = error.what();
  // What was not understood comes first: it may be why something else is missing.
  const std::vector<std::string> words = app.remaining(true);
  if (!words.empty()) {
    const std::string& word = words.front();
    if (word.starts_with("-")) return Error(word, name + " has no such option", help);
    if (subcommands.empty()) return Error(word, "is one argument too many for " + name, help);
    std::string known;
    for (const CLI::App* subcommand : subcommands)
      known += (known.empty() ? "" : ", ") + subcommand->get_name();
    return Error(word, "no such command", "give one of " + known);
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    return Error("SCENE", "none is named",
                 "name mesh files, a scene file or a built-in scene (farcull scenes lists them)");
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    for (const CLI::Option* option : command->get_options()) {
      if (option->count() > 1 && option->get_items_expected_max() == 1) {
        return Error(option->get_name(), fmt::format("is given {} times", option->count()),
                     "give it once");
      }
    }
    std::string option = text.substr(0, text.find_first_of(": "));
    if (text.find("override") != std::string::npos) {
      if (!option.starts_with("-")) option.insert(0, "--");
      return Error(option, "takes no value", "give " + option + " alone");
    }
    return Error(option, "its value is missing", help);
  }
  return Error(name, text, help);
}

}  // namespace

int command_line(int argc, char** argv) {
  prepare_output();
  // Mesa's own warnings about the devices it tries would stand beside our message, which says what
  // came of it.
  ::setenv("EGL_LOG_LEVEL", "fatal", 0);

  CLI::App app("farcull: collision culling that never misses.", "farcull");
  app.get_formatter()->column_width(28);
  app.set_help_flag("-h,--help", "print this and exit");
  app.set_version_flag("--version", std::string("farcull 0.1, commit ") + FARCULL_COMMIT,
                       "print the version and exit");
  app.require_subcommand(0, 1);
  app.footer(
      "Each has its own --help. Exit status: 0 done; 1 a guarantee is broken; 2 bad input or\n"
      "environment.\n\n"
      "Examples:\n"
      "  farcull run two-spheres\n"
      "  farcull run a.obj b.ply --resolution 1024 --pairs pairs.csv\n"
      "  farcull run cloth.obj --method far-pairs --self\n"
      "  farcull compare two-tori\n"
      "  farcull doctor");

  RunCommand run(RunCommand::Kind::run), verify(RunCommand::Kind::verify),
      plan(RunCommand::Kind::plan);
  CLI::App* run_app = run.add_to(app);
  CLI::App* verify_app = verify.add_to(app);
  CLI::App* plan_app = plan.add_to(app);

  CompareCommand comparison;
  CLI::App* compare_app = app.add_subcommand("compare", "methods and resolutions side by side");
  compare_app->add_option("SCENE", comparison.arguments.scene, kSceneHelp)
      ->required()
      ->type_name("");
  compare_app
      ->add_option("--methods", comparison.arguments.methods,
                   "separated by commas;\ndefault far,cullide,far-pairs,exact")
      ->type_name("LIST");
  compare_app
      ->add_option("--resolutions", comparison.arguments.resolutions,
                   "separated by commas;\ndefault 128,256,512,1024,2048; for far-pairs auto")
      ->type_name("LIST");
  compare_app
      ->add_option("--offsets", comparison.arguments.offsets,
                   "for far, separated by commas: obb, exact;\ndefault obb")
      ->type_name("LIST");
  compare_app
      ->add_option("--repeat", comparison.arguments.repeat,
                   "runs of each, the one with the median time is shown;\ndefault 1")
      ->type_name("N");
  compare_app->add_option("--views", comparison.views, kViewsHelp)->type_name("VIEWS");
  compare_app->add_option("--device", comparison.device, kRunDeviceHelp)->type_name("DEVICE");
  compare_app->add_flag("--self", comparison.arguments.self, kSelfHelp)->disable_flag_override();
  compare_app->add_option("--clearance", comparison.clearance, kClearanceHelp)->type_name("D");
  compare_app->add_option("--json", comparison.outputs.json, kJsonHelp)->type_name("FILE");
  compare_app->footer(
      "Examples:\n"
      "  farcull compare two-tori\n"
      "  farcull compare two-bunnies --methods far,exact --resolutions 256,512 --repeat 5\n"
      "  farcull compare mannequin-devil --methods far-pairs,exact --self\n\n"
      "Exit status 1: a method that promises missed a pair.");

  BenchCommand bench;
  CLI::App* bench_app = bench.add_to(app, kSceneHelp);

  DoctorArguments doctor;
  CLI::App* doctor_app =
      app.add_subcommand("doctor", "the devices, and what each assumption A1-A8 finds there");
  Text doctor_device, doctor_json;
  doctor_app->add_option("--device", doctor_device, kDeviceHelp)->type_name("DEVICE");
  doctor_app->add_option("--json", doctor_json, kJsonHelp)->type_name("FILE");
  doctor_app->footer(
      "Examples:\n  farcull doctor\n  farcull doctor --device software --json -\n\n"
      "What the probes find is kept for later runs, in $XDG_CACHE_HOME/farcull or\n"
      "~/.cache/farcull: far on OpenGL promises where all of A1 to A8 pass, far-pairs where\n"
      "A4, A7 and A8 do. A run without such a verdict on its device, driver and build makes\n"
      "one itself.\n\n"
      "Exit status 1: the device breaks an assumption: what relies on it promises nothing.");

  CheckArguments certificate;
  Text check_json, check_pairs;
  CLI::App* check_app = app.add_subcommand("check", "prove or refute a certificate of a run");
  check_app->add_option("CERTIFICATE", certificate.certificate, "as written by run --certificate")
      ->required()
      ->type_name("");
  check_app->add_option("SCENE", certificate.scene, kSceneHelp)->required()->type_name("");
  check_app
      ->add_flag("--self", certificate.self,
                 "every object was tested against itself, as by\nfarcull run --self")
      ->disable_flag_override();
  check_app
      ->add_option("--pairs", check_pairs,
                   "the list that farcull run --pairs wrote: is it the\none that is proved?")
      ->type_name("FILE");
  check_app->add_option("--json", check_json, kJsonHelp)->type_name("FILE");
  check_app->footer(
      "Examples:\n"
      "  farcull run two-spheres --certificate c.json --pairs pairs.csv\n"
      "  farcull check c.json two-spheres --pairs pairs.csv\n\n"
      "Exit status 0: proved: these pairs of the scene meet, and no others; 1: refuted, or not\n"
      "proved. Nothing is proved about the run: neither its method nor which pairs it kept.");

  ExperimentCommands experiments;
  CLI::App* experiment_app = experiments.add_to(app);

  MergeCommand merge;
  CLI::App* merge_app = merge.add_to(app);

  PictureCommand picture;
  CLI::App* picture_app = picture.add_to(app);

  ReportCommand report;
  CLI::App* report_app = report.add_to(app);

  ScenesCommand scenes;
  CLI::App* scenes_app = scenes.add_to(app);

  try {
    // For all that this thread does; core/parallel sets those that it starts. oneTBB's threads take
    // theirs from the thread that first uses it, which is this one.
    const FloatingPointGuard guard;
    try {
      app.parse(argc, argv);
    } catch (const CLI::Success& wanted) {  // --help, --version
      std::ostringstream out;
      app.exit(wanted, out, out);
      write_output("-", out.str());
      return kDone;
    } catch (const CLI::ParseError& error) {
      throw refusal(app, error);
    }
    if (*run_app) return run.run();
    if (*verify_app) return verify.run();
    if (*plan_app) return plan.run();
    if (*compare_app) return compare_command(comparison);
    if (*bench_app) return bench.run();
    if (*check_app) {
      check_scene(certificate.scene);
      if (check_pairs == "") throw Error("--pairs", "the path is empty", "name the list");
      certificate.pairs = check_pairs.value_or("");
      std::vector<NamedFile> inputs = scene_files(certificate.scene);
      inputs.push_back({"CERTIFICATE", certificate.certificate});
      if (check_pairs) inputs.push_back({"--pairs", *check_pairs});
      certificate.json = checked({.json = check_json}, inputs).json.value_or("");
      return check_command(certificate);
    }
    if (*experiment_app) return experiments.run();
    if (*merge_app) return merge.run();
    if (*picture_app) return picture.run();
    if (*report_app) return report.run();
    if (*scenes_app) return scenes.run();
    if (*doctor_app) {
      doctor.device = device_of(doctor_device);
      doctor.json = checked({.json = doctor_json}, {}).json.value_or("");
      return doctor_command(doctor);
    }
    std::fputs(app.help().c_str(), stderr);
    throw Error("COMMAND", "none is given", "name one, as in farcull run two-spheres");
  } catch (const Error& error) {
    complain(error.what());
  } catch (const std::bad_alloc&) {
    complain(kOutOfMemory);
  } catch (const std::system_error& error) {
    // Threads that cannot be started: each takes memory for its stack.
    const bool memory = error.code() == std::errc::resource_unavailable_try_again ||
                        error.code() == std::errc::not_enough_memory;
    complain(memory ? kOutOfMemory : fault(error));
  } catch (const std::exception& error) {
    complain(fault(error));
  }
  return kBad;
}

}  // namespace farcull
