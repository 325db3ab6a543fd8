// Reads the options of `farcull suite` and prints the counts. experiments/suite writes the files of
// a suite; suite/ask.py runs another program on these files.
#include <fmt/format.h>

#include "embedded/ask_py.h"
#include "experiments/command/command.h"
#include "experiments/suite/writer.h"
#include "experiments/system/output_file.h"
#include "experiments/system/python.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

std::string pairs_table(const std::vector<SuiteCounts>& families) {
  Table table("lrrrrrrrrrrr");
  std::vector<std::string> head = {"pairs", "all", "collide"};
  for (int k = 0; k < 9; ++k) head.push_back(to_string(static_cast<SuiteKind>(k)));
  table.add(head);
  std::uint64_t pairs = 0;
  std::uint64_t colliding = 0;
  for (const SuiteCounts& family : families) {
    std::vector<std::string> row = {family.name, grouped(family.pairs), grouped(family.colliding)};
    for (int k = 0; k < 9; ++k) row.push_back(family.kinds[k] > 0 ? grouped(family.kinds[k]) : "-");
    table.add(row);
    pairs += family.pairs;
    colliding += family.colliding;
  }
  table.add({"all", grouped(pairs), grouped(colliding), "", "", "", "", "", "", "", "", ""});
  return table.text();
}

std::string meshes_table(const std::vector<SuiteCounts>& meshes) {
  Table table("lrrr");
  table.add({"mesh", "triangles", "colliding pairs", "of neighbours"});
  for (const SuiteCounts& mesh : meshes) {
    table.add(
        {mesh.name, grouped(mesh.triangles), grouped(mesh.colliding), grouped(mesh.neighbours)});
  }
  return table.text();
}

class SuiteCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    return add_command(
        app, "suite", "labelled triangle pairs and meshes, to test any library with",
        {{"DIR", &folder_, "", "the folder to write, which must not exist or be empty", Need::must},
         {"--size", &size_, "small|full",
          "small: 10,070 pairs and 59 meshes, seconds (default);\nfull: 1,007,000 pairs and "
          "87 meshes, minutes"},
         {"--seed", &seed_, "N", "seed of all draws; default 1"},
         {"--ask", &ask_, "COMMAND",
          "ask the program that COMMAND starts about the suite in\nDIR, and print what it gets "
          "wrong (docs/ask.md)"}},
        "Examples:\n"
        "  farcull suite pairs-and-meshes\n"
        "  farcull suite large --size full\n"
        "  farcull suite pairs-and-meshes --ask 'python3 my_library.py'\n\n"
        "Every label is decided by two exact programs that share no code, CGAL's predicates\n"
        "and integers; a disagreement ends the command. The files depend on the size and the\nseed "
        "alone. docs/suite.md has the format. DIR/ask.py does what --ask does, without farcull.");
  }
  int run() const {
    if (folder_.empty()) throw Error("DIR", "the folder's name is empty", "name a folder");
    if (ask_ && (size_ || seed_))
      throw Error("--ask", "the suite itself says its size and its seed",
                  "leave --size and --seed out");
    if (ask_) {
      become_python({"-I", "-B", "-c", embedded::ask_py, "--suite", folder_, "--", *ask_},
                    "install Python 3.8 or later");
    }
    SuiteSettings settings;
    if (word_of("--size", size_, {"small", "full"}, "no size", "give small or full") == 1)
      settings.size = SuiteSize::full;
    if (seed_) {
      settings.seed = number_of<std::uint64_t>("--seed", *seed_, "no whole number", 0, UINT64_MAX,
                                               "give 0 or more");
    }
    check_output("-");
    TerminalProgress terminal;
    const SuiteSummary summary = write_suite(folder_, settings, terminal.callback());
    write_output(folder_ + "/ask.py", embedded::ask_py);
    terminal.clear();
    print(pairs_table(summary.families) + "\n" + meshes_table(summary.meshes) +
          fmt::format("\nwritten to {}: seed {}, size {}\nsum {}\n", folder_, summary.index.seed,
                      summary.index.size, summary.index.sum));
    return kExitDone;
  }

 private:
  std::string folder_;
  Text size_, seed_, ask_;
};

}  // namespace

Command add_suite(CLI::App& app) { return declare<SuiteCommand>(app); }

}  // namespace farcull
