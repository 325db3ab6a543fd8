// Makes the test suite, writes its files, and reads suite.txt. docs/suite.md has the format. The
// bytes depend only on the size and the seed, not on the machine or its number of cores.
#pragma once

#include "core/base/stage.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/suite/label.h"

namespace farcull {

enum class SuiteSize : std::uint8_t { small, full };

/// The contents of suite.txt, which lists the files of a suite.
struct SuiteIndex {
  struct File {
    std::string path;  // relative to the folder of the suite
    std::uint64_t bytes = 0;
    std::string sha256;       // 64 lower-case hexadecimal digits
    std::uint64_t items = 0;  // pairs, questions or triangles in the file; 0 for mesh.txt
  };

  std::uint64_t seed = 0;
  std::string size;  // "small" or "full"
  std::string licence;
  std::vector<File> files;  // sorted by path; read_suite() leaves the list empty
  std::string sum;          // SHA-256 of all lines but the last; identifies the suite
};

/// Reads size, seed and sum of FOLDER/suite.txt. Throws Error if the sum is not the SHA-256 of the
/// other lines. Does not check the listed files; ask.py does.
SuiteIndex read_suite(const std::string& folder);

struct SuiteSettings {
  SuiteSize size = SuiteSize::small;
  std::uint64_t seed = 1;
};

/// Numbers of pairs of a family or of a mesh.
struct SuiteCounts {
  std::string name;                       // name of the family or of the mesh
  std::uint64_t triangles = 0;            // triangles of the mesh; 0 for a family
  std::uint64_t pairs = 0;                // pairs of the family, or colliding pairs of the mesh
  std::uint64_t colliding = 0;            // colliding pairs; for a mesh, equal to `pairs`
  std::uint64_t neighbours = 0;           // colliding pairs of neighbours in a mesh; 0 for a family
  std::array<std::uint64_t, 10> kinds{};  // pairs of each SuiteKind; all 0 for a mesh
};

/// The index of the written files, and the counts of each family and each mesh.
struct SuiteSummary {
  SuiteIndex index;
  std::vector<SuiteCounts> families;
  std::vector<SuiteCounts> meshes;
};

SuiteCounts counts_of(const SuitePairs& pairs);
SuiteCounts counts_of(const SuiteMesh& mesh);

/// Returns pair `id` of a family, with kind SuiteKind::unlabelled. The pair depends only on the
/// seed, the name of the family and the ID. So any part of a suite can be made alone, and the
/// result does not depend on the number of threads.
SuitePair make_suite_pair(const PairFamily& family, std::uint64_t seed, std::uint64_t id);
/// Returns the pairs of a family with their labels, in the order of their IDs. Throws Error naming
/// the family and the pair if the two methods that compute a label disagree. Throws
/// std::logic_error if there is no such family.
SuitePairs make_pairs(const std::string& family, const SuiteSettings& settings);
/// Returns the names of the meshes of a suite of this size, such as "cloth-1", ascending.
std::vector<std::string> mesh_names(SuiteSize size);
/// Returns a mesh of the suite with its colliding pairs. Throws as make_pairs() does.
SuiteMesh make_mesh(const std::string& name, const SuiteSettings& settings);

/// Makes the suite in `folder`, which must be new or empty. suite.txt is written last, so a folder
/// without suite.txt is incomplete. Throws as make_pairs() does. Throws Error naming a path that
/// cannot be used.
SuiteSummary write_suite(const std::string& folder, const SuiteSettings& settings,
                         const Progress& progress = {});

}  // namespace farcull
