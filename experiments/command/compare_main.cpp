// farcull_compare of experiments/CMakeLists.txt: only `farcull compare`, with the same arguments.
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>

#include "core/base/floating_point.h"
#include "experiments/command/command.h"
#include "experiments/system/output_file.h"

int main(int argc, char** argv) {
  using namespace farcull;
  prepare_output();
  // The same settings as in the whole program; cli.cpp explains them.
  ::setenv("EGL_LOG_LEVEL", "fatal", 0);
  ::setenv("LP_NUM_THREADS", "0", 0);
  try {
    const FloatingPointGuard guard;
    CLI::App app("Compares the methods of farcull.", "farcull");
    const Command compare = add_compare(app);
    app.require_subcommand(1);
    CLI11_PARSE(app, argc, argv);
    return compare.run();
  } catch (const std::exception& error) {
    complain(error.what());
  }
  return kExitBad;
}
