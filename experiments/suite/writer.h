// Makes a suite, writes it as files, and reads the list of its files. docs/suite.md has the format.
// The bytes depend only on the size and the seed, not on the machine or its number of cores.
#pragma once

#include "core/base/stage.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/suite/label.h"

namespace farcull {

enum class SuiteSize : std::uint8_t { small, full };

/// The list of the files of a suite: suite.txt.
struct SuiteIndex {
  struct File {
    std::string path;  // relative to the folder
    std::uint64_t bytes = 0;
    std::string sha256;       // 64 lower-case hexadecimal digits
    std::uint64_t items = 0;  // pairs, or the triangles of an OBJ; 0 for mesh.txt
  };

  std::uint64_t seed = 0;
  std::string size;  // small or full
  std::string licence;
  std::vector<File> files;  // by path, ascending; read_suite() leaves this empty
  std::string sum;          // SHA-256 of all lines but the last; identifies the suite
};

/// Reads size, seed and sum of FOLDER/suite.txt. Throws Error if the sum is not that of the lines.
/// Does not check the listed files; ask.py checks these.
SuiteIndex read_suite(const std::string& folder);

struct SuiteSettings {
  SuiteSize size = SuiteSize::small;
  std::uint64_t seed = 1;
};

/// How many pairs of each kind a family or a mesh has.
struct SuiteCounts {
  std::string name;                       // of the family, or of the mesh
  std::uint64_t triangles = 0;            // of a mesh; 0 for a family of pairs
  std::uint64_t pairs = 0;                // for a mesh, only colliding pairs
  std::uint64_t colliding = 0;            // for a mesh, equal to `pairs`
  std::uint64_t neighbours = 0;           // colliding pairs of a mesh that are neighbours
  std::array<std::uint64_t, 10> kinds{};  // pairs of each SuiteKind; 0 for a mesh
};

/// Everything that was written.
struct SuiteSummary {
  SuiteIndex index;
  std::vector<SuiteCounts> families;
  std::vector<SuiteCounts> meshes;
};

SuiteCounts counts_of(const SuitePairs& pairs);
SuiteCounts counts_of(const SuiteMesh& mesh);

/// Returns pair `id` of a family, not decided yet (SuiteKind::unlabelled). The pair depends only on
/// the seed, the name of the family and the ID. So any part of a suite can be made alone, and the
/// number of threads changes nothing.
SuitePair make_suite_pair(const PairFamily& family, std::uint64_t seed, std::uint64_t id);
/// Returns the pairs of a family of this suite with their labels, in the order of their IDs. Throws
/// Error naming the family and the pair if two oracles disagree. Throws std::logic_error if there
/// is no such family.
SuitePairs make_pairs(const std::string& family, const SuiteSettings& settings);
/// The names of the meshes of this suite, such as "cloth-1", ascending.
std::vector<std::string> mesh_names(SuiteSize size);
/// Returns a mesh of this suite with its colliding pairs. Throws as make_pairs() does.
SuiteMesh make_mesh(const std::string& name, const SuiteSettings& settings);

/// Makes the suite in `folder`, which must be new or empty. suite.txt is written last, so a folder
/// without suite.txt is incomplete. Throws as make_pairs() does. Throws Error naming a path that
/// cannot be used.
SuiteSummary write_suite(const std::string& folder, const SuiteSettings& settings,
                         const Progress& progress = {});

}  // namespace farcull
