// `farcull help` prints what --help prints, or a text of docs/help, which is compiled in. `farcull
// man` sets the same as a manual page in the language of man(7), line by line as it was written:
// examples and lists stay what they are.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "embedded/methods_txt.h"
#include "embedded/pairs_txt.h"
#include "embedded/scene_file_txt.h"
#include "embedded/terms_txt.h"
#include "experiments/command/command.h"
#include "experiments/system/output_file.h"

namespace farcull {
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

}  // namespace

std::span<const HelpTopic> help_topics() { return kTopics; }

std::string help_topics_text() {
  std::string out;
  for (const HelpTopic& topic : help_topics())
    out += fmt::format("  farcull help {:<12}{}\n", topic.name, topic.title);
  return out;
}

namespace {

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
    if (words_.size() == 1) {
      for (const HelpTopic& topic : help_topics()) {
        if (words_[0] != topic.name) continue;
        write_help(topic.text);
        return kExitDone;
      }
    }
    const std::string text = help_of(*app_, words_);
    if (text.empty()) {
      std::string topics;
      for (const HelpTopic& topic : help_topics())
        topics += (topics.empty() ? "" : ", ") + std::string(topic.name);
      throw Error(fmt::format("{}", fmt::join(words_, " ")), "no such command or topic",
                  "give one of the topics " + topics + ", or a command that farcull help lists");
    }
    write_help(text);
    return kExitDone;
  }

 private:
  CLI::App* app_ = nullptr;
  std::vector<std::string> words_;
};

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

// Every command with its options and the end of its help.
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

class ManualCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    program_ = &app;
    return add_command(app, "man", "the manual page, farcull(1)", {},
                       "Examples:\n"
                       "  farcull man | man -l -\n"
                       "  farcull man >farcull.1");
  }
  int run() const {
    write_help(manual_page(declared(*program_), kVersion));
    return 0;
  }

 private:
  const CLI::App* program_ = nullptr;
};

}  // namespace

Command add_help(CLI::App& app) { return declare<HelpCommand>(app); }

Command add_manual(CLI::App& app) { return declare<ManualCommand>(app); }

}  // namespace farcull
