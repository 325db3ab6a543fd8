// Declares commands and their options, and answers what was given. Commands include this in place
// of <CLI/CLI.hpp>, which takes seconds of every file that includes it: only declare.cpp and
// cli.cpp do.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace farcull {

using Text = std::optional<std::string>;  // of an option; empty where it was not given

/// Declares a command below another one, or below the program. It lives as long as `parent`.
CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& title);
/// At most one of the commands below this one may be given.
void allow_one_command(CLI::App& command);
/// The end of the help; a function is called when the help is printed.
void add_footer(CLI::App& command, const std::string& text);
void add_footer(CLI::App& command, std::function<std::string()> text);

/// Declare an option with a value, or an argument where the name has no dashes; `type` stands for
/// the value in the help. `value` is written when the command line is parsed.
void add_option(CLI::App& command, const char* name, Text& value, const char* type,
                const std::string& help);
void add_option(CLI::App& command, const char* name, std::string& value, const char* type,
                const std::string& help);
void add_option(CLI::App& command, const char* name, std::uint64_t& value, const char* type,
                const std::string& help);
void add_option(CLI::App& command, const char* name, std::vector<std::string>& values,
                const char* type, const std::string& help);
/// Declare an argument that has to be given.
void add_required(CLI::App& command, const char* name, std::string& value, const char* help);
void add_required(CLI::App& command, const char* name, std::vector<std::string>& values,
                  const char* help);
/// Declares an option whose value may be left out.
CLI::Option* add_bare_option(CLI::App& command, const char* name, std::vector<std::string>& values,
                             const char* type, const char* help);
/// Declares an option without a value.
void add_flag(CLI::App& command, const char* name, bool& value, const std::string& help);

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

/// Whether the parsed command line has this.
bool given(const CLI::App& command);
bool given(const CLI::Option& option);

}  // namespace farcull
