// All that the commands need of CLI11, so that its templates are compiled once.
#include "experiments/command/declare.h"

#include <CLI/CLI.hpp>
#include <type_traits>
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

CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& title,
                      const Rows& options, const Footer& footer) {
  CLI::App* command = parent.add_subcommand(name, title);
  for (const OptionRow& row : options) {
    CLI::Option* option = nullptr;
    std::visit(
        [&](auto* value) {
          using Value = std::decay_t<decltype(*value)>;
          if constexpr (std::is_same_v<Value, bool>) {
            command->add_flag(row.name, *value, row.help)->disable_flag_override();
          } else if constexpr (std::is_same_v<Value, BareOption>) {
            option = command->add_option_function<std::vector<std::string>>(
                row.name,
                [value](const std::vector<std::string>& words) {
                  *value = {true, words.empty() ? "" : words.front()};
                },
                row.help);
            option->expected(0, 1);
          } else {
            option = command->add_option(row.name, *value, row.help);
          }
        },
        row.value);
    if (option != nullptr) option->type_name(row.type)->required(row.need == Need::must);
  }
  command->footer("");  // that of the parent, which comes behind a function's text otherwise
  std::visit([&](const auto& text) { command->footer(text); }, footer);
  return command;
}

void allow_one_command(CLI::App& command) { command.require_subcommand(0, 1); }

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

}  // namespace farcull
