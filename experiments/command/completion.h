// `farcull completion`: what a shell completes, made from the declared commands.
#pragma once

#include <string>
#include <vector>

#include "experiments/command/declare.h"

namespace farcull {

/// What a value can be, for the option or argument of this type.
struct CompletedValues {
  std::vector<std::string> words;
  bool files = false;   // any file
  bool meshes = false;  // files that a scene is read from
  bool folders = false;
};
/// By DeclaredOption::type: the words that an enumeration such as "fragment|fixed" names, what is
/// known by name (METHOD, SCENE, FILE, ...), nothing for numbers and other types.
CompletedValues completed_values(const std::string& type);

/// The script that a shell reads. shell: "bash", "zsh" or "fish". Throws Error naming SHELL for
/// another one.
std::string completion_script(const DeclaredCommand& program, const std::string& shell);

/// Declares the command; run() prints the script of the shell that was given.
class CompletionCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  int run() const;

 private:
  const CLI::App* program_ = nullptr;
  std::string shell_;
};

}  // namespace farcull
