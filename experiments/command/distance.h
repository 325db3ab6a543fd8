// `farcull distance`.
#pragma once

#include <string>
#include <vector>

#include "experiments/command/distance_diagram.h"
#include "experiments/command/options.h"
#include "experiments/method/distances.h"
#include "experiments/scenes/frames.h"

namespace farcull {

/// Declares the command on the program's options; run() runs it.
class DistanceCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 0 done, 1 the accounting found a nearer pair or a wrong answer, or
  /// the reliable diagram lost a nearest object. Throws Error
  /// where the arguments are bad.
  int run() const;

 private:
  DistanceOptions parse() const;
  unsigned threads() const;
  void require_no_distances() const;
  void require_question(const Scene& scene, const DistanceOptions& options) const;
  int run_once(const DistanceOptions& options, const Outputs& outputs) const;
  int run_frames(const DistanceOptions& options, const Outputs& outputs, FrameRange range) const;

  std::vector<std::string> scene_;
  Text pairs_, k_, within_, inside_, threads_, frames_;
  bool self_ = false, verify_ = false;
  DiagramArguments diagram_;
  Outputs outputs_;
};

}  // namespace farcull
