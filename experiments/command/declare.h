// The commands of the program, and what they declare: each names its options, and is run by what it
// gives back. Commands include this in place of <CLI/CLI.hpp>, which takes seconds of every file
// that includes it: only declare.cpp, cli.cpp and compare_main.cpp do.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace farcull {

/// The command line of farcull. Exit status: 0 done; 1 a guarantee is broken; 2 bad input or
/// environment, a device error included.
int command_line(int argc, char** argv);

using Text = std::optional<std::string>;  // of an option; empty where it was not given

/// An option whose value may be left out.
struct BareOption {
  bool given = false;
  std::string value;
};

enum class Need : std::uint8_t { may, must };

/// An option, or an argument where the name has no dashes. `value` is written when the command line
/// is parsed; that of a bool is a flag without a value. `type` stands for the value in the help.
struct OptionRow {
  const char* name;
  std::variant<bool*, Text*, std::string*, std::uint64_t*, std::vector<std::string>*, BareOption*>
      value;
  const char* type = "";
  std::string help;
  Need need = Need::may;
};
using Rows = std::vector<OptionRow>;
inline Rows operator+(Rows first, const Rows& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

/// The end of a help; a function is called when the help is printed.
using Footer = std::variant<const char*, std::string, std::function<std::string()>>;

/// Declares a command below another one, or below the program. It lives as long as `parent`.
CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& title,
                      const Rows& options, const Footer& footer);
/// At most one of the commands below this one may be given.
void allow_one_command(CLI::App& command);
/// Whether the parsed command line has this.
bool given(const CLI::App& command);

/// An option, or an argument where `names` is empty, as the help shows it.
struct DeclaredOption {
  std::vector<std::string> names;  // with their dashes, as in "-o", "--out"
  std::string type;  // stands for the value; empty for a flag. The name of an argument
  std::string help;  // lines as in the help
  bool flag = false;
  bool bare = false;      // its value may be left out
  bool many = false;      // an argument that may be given several times
  bool required = false;  // an argument that has to be given
};
/// A command as it was declared, with all below it: completion and the manual are made of this.
struct DeclaredCommand {
  std::string name;  // with those of its parents, as in "farcull experiment all"
  std::string title;
  std::string footer;
  std::vector<DeclaredOption> options;    // in the order of the help
  std::vector<DeclaredOption> arguments;  // in their order
  std::vector<DeclaredCommand> commands;
};
DeclaredCommand declared(const CLI::App& app);
/// What --help prints for the program (no names), a command of it, or a command below that one.
/// Empty where there is no such command.
std::string help_of(const CLI::App& app, const std::vector<std::string>& names);

/// A topic of `farcull help`: a file of docs/help.
struct HelpTopic {
  const char* name;   // one word
  const char* title;  // one line
  const char* text;   // ends with a newline
};
std::span<const HelpTopic> help_topics();
/// "terms: the words of the tables", a line for each topic, indented.
std::string help_topics_text();

/// A command that is declared. run() gives the exit status, and throws Error where the arguments
/// are bad.
struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

/// A command whose options are members of a class with add_to() and run().
template <class Class, class... Arguments>
Command declare(CLI::App& parent, const Arguments&... arguments) {
  const auto command = std::make_shared<Class>(arguments...);
  return {command->add_to(parent), [command] { return command->run(); }};
}

// Below the program, by exit status: 1 of run, verify and compare: a guarantee is broken. bench:
// two contestants disagree. distance: the accounting found a nearer pair or a wrong answer, or the
// reliable diagram lost a nearest object. doctor: an assumption does not hold on the device. check:
// refuted, or not proved. picture, report: a promise is broken.
Command add_run(CLI::App& app);
Command add_verify(CLI::App& app);
Command add_plan(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_distance(CLI::App& app);
Command add_bench(CLI::App& app);
Command add_doctor(CLI::App& app);
Command add_check(CLI::App& app);
Command add_experiment(CLI::App& app);
Command add_merge(CLI::App& app);
Command add_picture(CLI::App& app);
Command add_report(CLI::App& app);
Command add_scenes(CLI::App& app);
Command add_suite(CLI::App& app);
Command add_help(CLI::App& app);
Command add_completion(CLI::App& app);
Command add_manual(CLI::App& app);

// Below `farcull experiment`. 1 of lemma: a violation at the budget radius or beyond.
Command add_lemma(CLI::App& experiment);
/// A command for each study, and `all`: 1 where a method that promises missed, 2 where a point
/// could not be measured.
std::vector<Command> add_studies(CLI::App& experiment);

/// The folder of results unless --out says otherwise; `farcull report` reads it.
inline constexpr const char* kResultsFolder = "farcull-results";

}  // namespace farcull
