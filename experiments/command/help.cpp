// Prints what --help prints, or a text of docs/help, which is compiled in.
#include "experiments/command/help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "core/base/error.h"
#include "embedded/methods_txt.h"
#include "embedded/pairs_txt.h"
#include "embedded/scene_file_txt.h"
#include "embedded/terms_txt.h"
#include "experiments/command/options.h"
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

CLI::App* HelpCommand::add_to(CLI::App& app) {
  app_ = &app;
  CLI::App* command = add_command(app, "help", "the help of a command, or of a topic");
  add_option(*command, "TOPIC|COMMAND", words_, "",
             "what to explain; default the list of commands");
  add_footer(*command, [] {
    return "Topics:\n" + help_topics_text() +
           "\nExamples:\n"
           "  farcull help terms\n"
           "  farcull help run\n"
           "  farcull help experiment accuracy";
  });
  return command;
}

int HelpCommand::run() const {
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

}  // namespace farcull
