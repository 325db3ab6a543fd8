// Help is set line by line as it was written: its examples and lists stay what they are.
#include "experiments/command/manual.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/command/options.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

// Text of roff that prints as it is, also what begins a line.
std::string roff(const std::string& text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    begins = c == '\n';
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

// Lines that are filled to the width of the page.
std::string filled(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return roff(text) + "\n";
}

// Lines that stay as they are.
std::string lines(const std::string& text) {
  std::string out = ".PP\n.nf\n";
  const std::size_t end = text.find_last_not_of('\n');
  bool empty = false;
  std::string line;
  for (const char c : text.substr(0, end == std::string::npos ? 0 : end + 1) + "\n") {
    if (c != '\n') {
      line += c;
      continue;
    }
    // A line without text would be a break of roff's own.
    if (line.empty()) {
      empty = true;
    } else {
      out += (empty ? ".sp\n" : "") + roff(line) + "\n";
      empty = false;
    }
    line.clear();
  }
  return out + ".fi\n";
}

std::string tag(const DeclaredOption& option) {
  std::string out;
  for (const std::string& name : option.names) out += (out.empty() ? "" : ", ") + bold(name);
  if (option.names.empty()) return italic(option.type) + (option.many ? " ..." : "");
  if (option.flag) return out;
  return out + (option.bare ? " [" + italic(option.type) + "]" : " " + italic(option.type));
}

std::string usage(const DeclaredCommand& command) {
  std::string out = bold(command.name);
  if (!command.options.empty()) out += " [" + italic("options") + "]";
  for (const DeclaredOption& argument : command.arguments) {
    const std::string name = italic(argument.type) + (argument.many ? " ..." : "");
    out += argument.required ? " " + name : " [" + name + "]";
  }
  if (!command.commands.empty()) out += " [" + italic("command") + "]";
  return out + "\n";
}

void add(const DeclaredCommand& command, std::string& page) {
  page +=
      ".SS " + roff(command.name) + "\n" + filled(command.title + ".") + ".PP\n" + usage(command);
  for (const auto* list : {&command.arguments, &command.options}) {
    for (const DeclaredOption& option : *list)
      page += ".TP\n" + tag(option) + "\n" + filled(option.help);
  }
  if (!command.footer.empty()) page += lines(command.footer);
  for (const DeclaredCommand& below : command.commands) add(below, page);
}

}  // namespace

std::string manual_page(const DeclaredCommand& program, const std::string& version) {
  std::string page = fmt::format(
      ".\\\" Made by `farcull man`.\n"
      ".TH FARCULL 1 \"\" \"{}\" \"User commands\"\n"
      ".SH NAME\nfarcull \\- collision culling that never misses\n"
      ".SH SYNOPSIS\n{} {} [{}]\n"
      ".SH DESCRIPTION\n",
      roff(version), bold("farcull"), italic("command"), italic("options"));
  page += filled(
      "farcull finds the triangles that collide. It culls by drawing triangles or by comparing "
      "boxes, and never culls a pair that intersects. A scene is one or more meshes, a scene file, "
      "or the name of a "
      "built-in scene.");
  for (const DeclaredOption& option : program.options)
    page += ".TP\n" + tag(option) + "\n" + filled(option.help);
  page += lines(program.footer) + ".SH COMMANDS\n";
  for (const DeclaredCommand& command : program.commands) add(command, page);
  return page;
}

CLI::App* ManualCommand::add_to(CLI::App& app) {
  program_ = &app;
  CLI::App* command = add_command(app, "man", "the manual page, farcull(1)");
  add_footer(*command,
             "Examples:\n"
             "  farcull man | man -l -\n"
             "  farcull man >farcull.1");
  return command;
}

int ManualCommand::run() const {
  write_help(manual_page(declared(*program_), kVersion));
  return 0;
}

}  // namespace farcull
