// Of the study "libraries": the smallest pair of each kind of fault, as a table, as a picture and
// as a file in the format of the suite.
#pragma once

#include "experiments/report/chapters/chapter.h"

namespace farcull {

/// A pair at which a contestant errs, minimized, as a row of the store has it.
struct LibraryExample {
  std::string contestant;
  std::string fault;   // "missed", "false" (a false alarm) or "death"
  std::string family;  // of the pair that it was made from
  std::string line;    // suite/writer.h, pair_line()
};

/// The number of characters of its coordinates in decimal, by which examples are compared.
std::size_t digits_of(const LibraryExample& example);

/// Adds the table "libraries-examples"; the file "libraries-examples.txt", in the format of a
/// family of the suite, with a comment before each pair that says whose fault it is; and figures
/// "libraries-examples-missed" and "-false", with a panel for each pair. Adds nothing where there
/// are no examples. Throws Error where a line is none of a pair.
void add_examples(const std::vector<LibraryExample>& examples, Chapter& chapter);

}  // namespace farcull
