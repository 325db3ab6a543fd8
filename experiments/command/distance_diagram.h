// `farcull distance --voronoi`: potential neighbours by a discrete Voronoi diagram.
#pragma once

#include <string>
#include <vector>

#include "experiments/command/options.h"
#include "experiments/measure/potential_neighbours.h"

namespace farcull {

/// Options that go with --voronoi alone.
class DiagramArguments {
 public:
  void add_to(CLI::App& command);
  /// Whether --voronoi was given. Throws Error where another of these was given without it.
  bool asked() const;
  /// threads: 0 for as many as there are cores. Throws Error naming the option that is bad.
  DiagramOptions parse(unsigned threads) const;

 private:
  Text diagram_, resolution_, device_;
};

/// Writes the record of the scene to the outputs. The exit status: 0 done, 1 the reliable form lost
/// a nearest object.
int run_diagram(const std::vector<std::string>& scene, const DiagramOptions& options,
                const Outputs& outputs);

}  // namespace farcull
