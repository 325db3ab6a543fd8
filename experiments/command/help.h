// `farcull help`: the help of a command, or a topic. The topics are the files of docs/help.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/command/declare.h"

namespace farcull {

struct HelpTopic {
  const char* name;   // one word
  const char* title;  // one line
  const char* text;   // ends with a newline
};
std::span<const HelpTopic> help_topics();

/// "terms: the words of the tables", a line for each topic, indented.
std::string help_topics_text();

class HelpCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status. Throws Error where there is no such topic or command.
  int run() const;

 private:
  CLI::App* app_ = nullptr;
  std::vector<std::string> words_;
};

}  // namespace farcull
