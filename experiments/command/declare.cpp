// All that the commands need of CLI11, so that its templates are compiled once.
#include "experiments/command/declare.h"

#include <CLI/CLI.hpp>
#include <utility>

namespace farcull {
namespace {

DeclaredCommand declared(const CLI::App& app, const std::string& parents) {
  DeclaredCommand out;
  out.name = parents.empty() ? app.get_name() : parents + " " + app.get_name();
  out.title = app.get_description();
  out.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options()) {
    DeclaredOption one;
    for (const std::string& name : option->get_snames()) one.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) one.names.push_back("--" + name);
    one.flag = !option->get_positional() && option->get_items_expected_max() == 0;
    one.bare = !one.flag && option->get_items_expected_min() == 0;
    one.many = option->get_items_expected_max() > 1;
    one.required = option->get_required();
    one.help = option->get_description();
    one.type = option->get_positional() ? option->get_name(true)
               : one.flag               ? ""
                                        : option->get_type_name();
    (option->get_positional() ? out.arguments : out.options).push_back(std::move(one));
  }
  for (const CLI::App* command : app.get_subcommands({}))
    out.commands.push_back(declared(*command, out.name));
  return out;
}

}  // namespace

DeclaredCommand declared(const CLI::App& app) { return declared(app, ""); }

CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& title) {
  return parent.add_subcommand(name, title);
}

void allow_one_command(CLI::App& command) { command.require_subcommand(0, 1); }

void add_footer(CLI::App& command, const std::string& text) { command.footer(text); }

void add_footer(CLI::App& command, std::function<std::string()> text) {
  command.footer("");  // that of the parent, which comes behind the text otherwise
  command.footer(std::move(text));
}

void add_option(CLI::App& command, const char* name, Text& value, const char* type,
                const std::string& help) {
  command.add_option(name, value, help)->type_name(type);
}

void add_option(CLI::App& command, const char* name, std::string& value, const char* type,
                const std::string& help) {
  command.add_option(name, value, help)->type_name(type);
}

void add_option(CLI::App& command, const char* name, std::uint64_t& value, const char* type,
                const std::string& help) {
  command.add_option(name, value, help)->type_name(type);
}

void add_option(CLI::App& command, const char* name, std::vector<std::string>& values,
                const char* type, const std::string& help) {
  command.add_option(name, values, help)->type_name(type);
}

void add_required(CLI::App& command, const char* name, std::string& value, const char* help) {
  command.add_option(name, value, help)->required()->type_name("");
}

void add_required(CLI::App& command, const char* name, std::vector<std::string>& values,
                  const char* help) {
  command.add_option(name, values, help)->required()->type_name("");
}

CLI::Option* add_bare_option(CLI::App& command, const char* name, std::vector<std::string>& values,
                             const char* type, const char* help) {
  return command.add_option(name, values, help)->type_name(type)->expected(0, 1);
}

void add_flag(CLI::App& command, const char* name, bool& value, const std::string& help) {
  command.add_flag(name, value, help)->disable_flag_override();
}

std::string help_of(const CLI::App& app, const std::vector<std::string>& names) {
  const CLI::App* command = &app;
  std::string before;
  for (const std::string& name : names) {
    const CLI::App* found = nullptr;
    for (const CLI::App* below : command->get_subcommands({})) {
      if (below->get_name() == name) found = below;
    }
    if (found == nullptr) return "";
    before += (before.empty() ? "" : " ") + command->get_name();
    command = found;
  }
  // The formatter itself, since App::help() describes the command that was parsed, which is `help`.
  return command->get_formatter()->make_help(
      command, before.empty() ? command->get_name() : before + " " + command->get_name(),
      CLI::AppFormatMode::Normal);
}

bool given(const CLI::App& command) { return command.parsed(); }

bool given(const CLI::Option& option) { return option.count() > 0; }

}  // namespace farcull
