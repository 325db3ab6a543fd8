// Runs of a method, each in a session of its own.
#pragma once

#include "experiments/method/run.h"

namespace farcull::lab {

/// On the cores of the CPU, where the method draws at 64 px.
inline RunOptions on_cpu(Method method, double clearance = 0) {
  RunOptions options;
  options.method = method;
  options.device = "cpu";
  options.resolution = draws(method) ? 64 : 0;
  options.clearance = clearance;
  return options;
}

inline Record run(const Scene& scene, const RunOptions& options) {
  Session session(options.device);
  return farcull::run(scene, options, session);
}

}  // namespace farcull::lab
