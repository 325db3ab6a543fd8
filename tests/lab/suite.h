// A suite of a few pairs and one mesh to corrupt.
#pragma once

#include "core/base/bytes.h"
#include "experiments/suite/writer.h"
#include "tests/lab/test.h"

namespace farcull::lab {

/// A file of three pairs that is right.
inline std::string good_pairs() {
  return "farcull-pairs 1 few\n"
         "# a comment\n"
         "0 0.5 - crossing 0x0p+0 0x0p+0 0x0p+0 0x1p+2 0x0p+0 0x0p+0 0x0p+0 0x1p+2 0x0p+0 "
         "0x1p+0 0x1p+0 -0x1p+0 0x1p+0 0x1p+0 0x1p+0 0x1.8p+1 0x1.8p+1 0x0p+0\n"
         "1 1e-9 - apart 0x0p+0 0x0p+0 0x0p+0 0x1p+2 0x0p+0 0x0p+0 0x0p+0 0x1p+2 0x0p+0 "
         "0x1p+0 0x1p+0 0x1p-52 0x1p+0 0x1p+0 0x1p+0 0x1.8p+1 0x1.8p+1 0x1p+0\n"
         "2 0 0-0,1-1 neighbours-apart 0x0p+0 0x0p+0 0x0p+0 0x1p+2 0x0p+0 0x0p+0 0x0p+0 0x1p+2 "
         "0x0p+0 0x0p+0 0x0p+0 0x0p+0 0x1p+2 0x0p+0 0x0p+0 0x0p+0 0x1p+0 0x1p-40\n";
}

/// suite.txt for the files that are there now; `listed` is what it says of the mesh's pairs.
inline void write_index(const ScratchFolder& folder, int listed = 1) {
  SuiteIndex index;
  index.seed = 1;
  index.size = "small";
  index.licence = "CC0-1.0";
  for (const auto& [name, items] : {std::pair{"meshes/two-1/0.obj", 2},
                                    {"meshes/two-1/mesh.txt", 0},
                                    {"meshes/two-1/pairs.csv", listed},
                                    {"pairs/few.txt", 3}}) {
    const std::string text = folder.read(name);
    index.files.push_back({name, text.size(), sha256(text), static_cast<std::uint64_t>(items)});
  }
  folder.write("suite.txt", index_text(index));
}

/// A suite that is right: three pairs, and a mesh of two triangles that lie on each other.
inline void write_few(const ScratchFolder& folder) {
  folder.write("pairs/few.txt", good_pairs());
  folder.write("meshes/two-1/0.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 0\nf 1 2 3\nf 1 2 4\n");
  folder.write("meshes/two-1/mesh.txt", "self yes\nparameter 0\nfamily two\n");
  folder.write("meshes/two-1/pairs.csv",
               "object_a,triangle_a,object_b,triangle_b,shared\n0,0,0,1,2\n");
  write_index(folder);
}

}  // namespace farcull::lab
