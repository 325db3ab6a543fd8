// Declares the commands, parses the command line, runs the command, and prints help.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "commit.h"
#include "core/base/floating_point.h"
#include "embedded/methods_txt.h"
#include "embedded/pairs_txt.h"
#include "embedded/scene_file_txt.h"
#include "embedded/terms_txt.h"
#include "experiments/command/command.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/system/output_file.h"

namespace farcull {

// `farcull help` prints the --help of a command, or a file of docs/help that is compiled in.

namespace {

constexpr std::array kTopics = {
    HelpTopic{"methods", "what each method does, and which one to use", embedded::methods_txt},
    HelpTopic{"pairs", "the columns of --pairs, and how faces become triangles",
              embedded::pairs_txt},
    HelpTopic{"scene-file", "how to place meshes: scale, rotate, translate",
              embedded::scene_file_txt},
    HelpTopic{"terms", "the words of the tables", embedded::terms_txt},
    // A new topic goes here.
};

// Returns an indented line for each topic, with its name and title.
std::string help_topics_text() {
  std::string out;
  for (const HelpTopic& topic : kTopics)
    out += fmt::format("  farcull help {:<12}{}\n", topic.name, topic.title);
  return out;
}

class HelpCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    app_ = &app;
    return add_command(
        app, "help", "the help of a command, or of a topic",
        {{"TOPIC|COMMAND", &words_, "", "what to explain; default the list of commands"}}, [] {
          return "Topics:\n" + help_topics_text() +
                 "\nExamples:\n"
                 "  farcull help terms\n"
                 "  farcull help run\n"
                 "  farcull help experiment accuracy";
        });
  }
  int run() const {
    std::string text = help_of(*app_, words_);
    std::vector<std::string> topics;
    for (const HelpTopic& topic : kTopics) {
      topics.emplace_back(topic.name);
      if (words_.size() == 1 && words_[0] == topic.name) text = topic.text;
    }
    if (text.empty()) {
      throw Error(
          fmt::format("{}", fmt::join(words_, " ")), "no such command or topic",
          fmt::format("{}give one of the topics {}, or a command that farcull help lists",
                      did_you_mean(likely_word(words_[0], topics)), fmt::join(topics, ", ")));
    }
    write_help(text);
    return kExitDone;
  }

 private:
  CLI::App* app_ = nullptr;
  std::vector<std::string> words_;
};

constexpr const char* kOutOfMemory =
    "memory: there is not enough; use a smaller scene or resolution, a higher limit (ulimit -v) or "
    "a machine with more memory";

std::string fault(const std::exception& error) {
  return std::string("a fault of farcull itself: ") + error.what() +
         "; report it with the command line";
}

// Turns an error of CLI11 into an Error with a remedy. app: the program after parsing failed.
Error refusal(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = &app;
  std::string name = "farcull";
  const auto parsed = [](const CLI::App* subcommand) { return subcommand->parsed(); };
  for (auto named = app.get_subcommands(parsed); !named.empty();
       named = command->get_subcommands(parsed)) {
    command = named.front();
    name += " " + command->get_name();
  }
  const std::vector<const CLI::App*> subcommands = command->get_subcommands({});
  const std::string help = "see " + name + " --help";
  const std::string text = error.what();
  // Unknown words are reported first, since they may cause the other errors.
  const std::vector<std::string> words = app.remaining(true);
  if (!words.empty()) {
    const std::string& word = words.front();
    if (word == "--boxes" || word.starts_with("--boxes="))
      return Error("--boxes", "is now called --broad-phase",
                   "give that, with objects or triangles");
    if (word.starts_with("-")) {
      std::vector<std::string> known;
      for (const CLI::Option* option : command->get_options()) known.push_back(option->get_name());
      const std::string only = word.substr(0, word.find('='));
      return Error(word, name + " has no such option",
                   did_you_mean(likely_word(only, known)) + help);
    }
    if (subcommands.empty()) return Error(word, "is one argument too many for " + name, help);
    std::vector<std::string> known;
    for (const CLI::App* subcommand : subcommands) known.push_back(subcommand->get_name());
    if (const std::string meant = likely_word(word, known); !meant.empty()) {
      return Error(
          word, "no such command",
          "try " + command_with(name + " " + meant, std::vector(words.begin() + 1, words.end())));
    }
    if (command == &app && (has_mesh_extension(word) || is_scene_file(word) ||
                            is_builtin_scene(word) || std::filesystem::is_directory(word))) {
      const char* const act = std::filesystem::is_directory(word) ? " clash" : " run";
      return Error(word, "stands where a command should", "try " + command_with(name + act, words));
    }
    return Error(word, "no such command", fmt::format("give one of {}", fmt::join(known, ", ")));
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

// Returns the error. If standard output failed, the remedy names the option that was given `-`, and
// says to name a file.
Error with_option(const Error& error, int argc, char** argv) {
  constexpr std::array kOutputs = {"--json", "--csv", "--pairs", "--certificate", "-o", "--output"};
  if (error.where != "standard output") return error;
  for (int k = 2; k < argc; ++k) {
    const std::string option = argv[k - 1];
    if (argv[k] == std::string("-") && std::ranges::find(kOutputs, option) != kOutputs.end())
      return Error(error.where, error.reason, "name a file instead: " + option + " FILE");
  }
  return error;
}

constexpr const char* kFirstScreen =
    "Give it two meshes (OBJ, OFF, PLY or STL files):\n"
    "  farcull run a.obj b.obj                    which triangles collide\n"
    "  farcull run a.obj b.obj --pairs pairs.csv  the same, as a list\n"
    "  farcull run cloth.obj --self               a mesh against itself\n"
    "  farcull clash parts/                       which parts of an assembly clash\n"
    "  farcull distance a.obj b.obj               how far apart they are, and where\n"
    "Or none:\n"
    "  farcull run two-tori                       a built-in scene; farcull scenes lists them\n"
    "  farcull compare two-tori                   what each method misses, and its time\n";

int dispatch(int argc, char** argv) {
  CLI::App app("", "farcull");
  app.get_formatter()->column_width(28);
  app.set_help_flag("-h,--help", "print this and exit");
  app.set_version_flag("--version", std::string(kVersion) + ", commit " + FARCULL_COMMIT,
                       "print the version and exit");
  app.require_subcommand(0, 1);
  app.description(kFirstScreen);
  app.footer(
      "Each has its own --help. Exit status: 0 done; 1 a guarantee is broken; 2 bad input or\n"
      "environment.\n\n"
      "Topics:\n" +
      help_topics_text());
  std::vector<Command> commands;  // in the order of the help
  for (Command (*const add)(CLI::App&) :
       {add_run, add_verify, add_plan, add_compare, add_distance, add_clash, add_bench, add_doctor,
        add_check, add_experiment, add_merge, add_picture, add_report, add_scenes, add_suite,
        add_help, add_completion})
    commands.push_back(add(app));

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wanted) {  // --help or --version
    std::ostringstream out;
    app.exit(wanted, out, out);
    write_help(out.str());
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    throw refusal(app, error);
  }
  for (const Command& command : commands) {
    if (*command.app) return command.run();
  }
  std::fprintf(stderr, "%s\n%s\n", kFirstScreen, "farcull --help lists all commands.");
  return kExitBad;
}

}  // namespace

std::span<const HelpTopic> help_topics() { return kTopics; }

Command add_help(CLI::App& app) { return declare<HelpCommand>(app); }

int command_line(int argc, char** argv) {
  prepare_output();
  spell_parameters(option_word);
  // Stops Mesa's warnings about devices that it tries. farcull prints its own messages.
  ::setenv("EGL_LOG_LEVEL", "fatal", 0);
  // Stops llvmpipe from starting threads, which may corrupt this process's memory
  // (docs/drivers.md). setenv() is safe here, since no other thread runs yet.
  ::setenv("LP_NUM_THREADS", "0", 0);
  const Interruptible interruptible;
  try {
    // This guard is for the main thread. core/base/parallel.h makes a guard for each thread.
    const FloatingPointGuard guard;
    return dispatch(argc, argv);
  } catch (const Error& error) {
    complain(with_option(error, argc, argv).what());
  } catch (const std::bad_alloc&) {
    complain(kOutOfMemory);
  } catch (const std::system_error& error) {
    // The system could not start a thread, perhaps for lack of memory for the thread's stack.
    const bool memory = error.code() == std::errc::resource_unavailable_try_again ||
                        error.code() == std::errc::not_enough_memory;
    complain(memory ? kOutOfMemory : fault(error));
  } catch (const std::exception& error) {
    complain(fault(error));
  }
  return kExitBad;
}

}  // namespace farcull
