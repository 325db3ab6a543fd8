// Writes the figures of the paper: farcull_figures CASE FOLDER, with CASE as in
// experiments/picture/paper.h.
#include <fmt/format.h>

#include <exception>
#include <fstream>

#include "core/base/floating_point.h"
#include "experiments/picture/paper.h"

int main(int count, char** words) {
  if (count != 3) {
    fmt::print(stderr, "usage: farcull_figures CASE FOLDER\n");
    return 2;
  }
  try {
    const farcull::FloatingPointGuard guard;
    for (const farcull::PaperFigure& figure : farcull::paper_figures(words[1])) {
      const std::string path = fmt::format("{}/{}.svg", words[2], figure.name);
      std::ofstream file(path, std::ios::binary);
      file << figure.svg;
      if (!file.flush()) {
        fmt::print(stderr, "farcull_figures: {} cannot be written\n", path);
        return 2;
      }
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "farcull_figures: {}\n", error.what());
    return 2;
  }
  return 0;
}
