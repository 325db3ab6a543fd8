// `farcull man`: the manual page, made from the declared commands.
#pragma once

#include <string>

#include "experiments/command/declare.h"

namespace farcull {

/// The page in the language of man(7): every command with its options and the end of its help.
std::string manual_page(const DeclaredCommand& program, const std::string& version);

/// Declares the command; run() prints the page.
class ManualCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  int run() const;

 private:
  const CLI::App* program_ = nullptr;
};

}  // namespace farcull
