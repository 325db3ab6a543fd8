// `farcull check`: a certificate against the scene that it speaks about.
#pragma once

#include <string>
#include <vector>

#include "experiments/command/options.h"

namespace farcull {

struct CheckArguments {
  std::string certificate;         // a file
  std::vector<std::string> scene;  // as of `farcull run`
  std::string json = {};           // "" for none, "-" for standard output instead of the text
  bool self = false;               // every object is tested against itself, as by run --self
  std::string pairs = {};          // "" for none, or the list that `farcull run --pairs` wrote
};

/// Prints the verdict. 0: proved, and the list that is given is the one that is proved; 1: refuted
/// or not proved. Throws Error where the certificate, the scene or the list cannot be read.
int check_certificate_file(const CheckArguments& arguments);

/// Declares the command on the program's options; run() runs it.
class CheckCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status of check_certificate_file(). Throws Error where the arguments are bad.
  int run();

 private:
  CheckArguments arguments_;
  Text json_, pairs_;
};

}  // namespace farcull
