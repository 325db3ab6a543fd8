// `farcull run`, `farcull verify` and `farcull plan`.
#pragma once

#include <string>
#include <vector>

#include "experiments/command/options.h"
#include "experiments/record/output.h"
#include "experiments/scenes/frames.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/tiles/run_tile.h"

namespace farcull {

/// Declares one of the three commands on the program's options; run() runs it.
class RunCommand {
 public:
  /// verify asks the guarantee of every method; plan prints what run would do.
  enum class Kind { run, verify, plan };
  explicit RunCommand(Kind kind) : kind_(kind) {}
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 0 done, 1 a guarantee is broken. Throws Error where the arguments are bad.
  int run() const;

 private:
  /// The options of the method. Throws Error where one is bad, or options do not go together.
  RunOptions parse() const;
  void add_outputs(CLI::App& command);
  /// Throws Error where an output cannot say what another option asks.
  void refuse_outputs() const;
  PairColumns columns() const;
  std::vector<IgnoredNames> ignored() const;
  /// What the command reads, which no output may overwrite.
  std::vector<NamedFile> read_files(const std::optional<FrameRange>& range = {}) const;
  /// The command line that tests a scene of one object.
  std::string with_self() const;
  /// Of verify: the verdict, green or red on a terminal; else empty.
  std::string verdict_line(const Accounting& accounting) const;
  /// The scene part by part.
  SceneSource source() const;
  /// Throws Error where an option cannot be answered tile by tile.
  void refuse_with_tiles(const RunOptions& options) const;
  int run_tile(const RunOptions& options) const;
  int plan_tiles(const RunOptions& options) const;
  int plan(const RunOptions& options) const;
  int run_once(const RunOptions& options, const Outputs& outputs) const;
  int run_frames(const RunOptions& options, const Outputs& outputs, FrameRange range) const;

  Kind kind_;
  std::vector<std::string> scene_;
  MethodOptions options_;
  Text frames_, kinds_, tiles_;
  Outputs outputs_;
  bool no_verify_ = false, faces_ = false, contacts_ = false, segments_ = false;
};

}  // namespace farcull
