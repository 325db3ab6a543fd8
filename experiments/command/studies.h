// `farcull experiment NAME|all` for the studies that the store keeps, and `farcull merge`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/command/options.h"
#include "experiments/studies/run_studies.h"

namespace farcull {

/// Where results go unless --out says otherwise; also what `farcull report` reads.
inline constexpr const char* kResultsFolder = "farcull-results";

class StudiesCommand {
 public:
  /// Declares each study, and `all`, as a command of its own below `experiment`.
  void add_to(CLI::App& experiment);
  /// True where the command line named one of them.
  bool named() const;
  /// The exit status: 0; 1 where a method that promises missed; 2 where a point could not be
  /// measured. Throws Error for bad arguments and as run_studies() does.
  int run();

 private:
  std::vector<CLI::App*> commands_;  // of studies() and, last, all
  /// The devices to measure on, one after the other: those of --devices, or that of --device.
  std::vector<std::string> devices() const;
  int run_on(StudiesRequest request, const std::string& name) const;

  std::string out_ = kResultsFolder;
  bool quick_ = false, resume_ = false;
  std::uint64_t seed_ = 1;
  Text shard_, device_, devices_, suite_, contestants_;
};

class MergeCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status. Throws Error as merge_stores() does.
  int run();

 private:
  int run_tiles() const;

  std::vector<std::string> sources_;
  Text out_, json_;
};

}  // namespace farcull
