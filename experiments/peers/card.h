// The card of a contestant: what it is, and what its documentation promises.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace farcull {

/// Which pairs of triangles a library calls colliding, by its documentation.
enum class Means : std::uint8_t {
  closed,    // closed triangles: touching counts
  crossing,  // those that cross; what it says of touching and coplanar ones is left open
};

struct ContestantCard {
  std::string name = {};     // [a-z0-9-]
  std::string library = {};  // with its version, such as "CGAL 5.5.1"
  Means means = Means::closed;
  bool degenerate = true;   // it takes triangles that are segments or points
  bool neighbours = false;  // it is told which corners two triangles share, and leaves that out
  double margin = 0;  // units: triangles that are no farther apart than this may count as colliding
  bool promises = false;               // ours alone: a miss breaks a promise
  bool pairs = false, meshes = false;  // what it can be asked
  std::uint64_t memory_mib = 4096;     // of addresses, that its process may have
  std::string call = {};               // the function that is called, and with what
  std::string says = {};               // what its documentation says of exactness and of touching
  std::string source = {};             // where it says that; others' contestants may leave it out
  std::string use = {};                // where it is right to be used
};

/// Lines `KEY VALUE`, and an empty one at the end. The keys are the names above, but `memory`
/// (MiB); `means` is closed or crossing, and what is true or false is yes or no.
std::string card_text(const ContestantCard& card);

/// Reads what `PROGRAM list` printed. Throws Error naming `where` and the line.
std::vector<ContestantCard> read_cards(std::string_view text, const std::string& where);

}  // namespace farcull
