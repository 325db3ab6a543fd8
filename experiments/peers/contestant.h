// The protocol of contestants. A contestant of the study "libraries" is a library, called as its
// documentation says, in a program of its own that reads questions as text and answers them.
//
// Each library has a program of its own, and not a command of farcull, for three reasons. It may
// crash, hang or take all memory. Libraries do not go together in one program: Bullet is there in
// float and in double under the same names. And a program in any language can take part.
//
// The program is called in one of three ways. Fields of a line stand between tabulators. NUMBER is
// that of the question, which the answer repeats.
//   PROGRAM list          prints a card for each of its contestants (ContestantCard)
//   PROGRAM NAME pairs    reads a pair of triangles a line:
//                           NUMBER SHARED, then 18 coordinates as decimal numbers that a reader of
//                           doubles gives back exactly; SHARED as in a suite, `-` for none
//                         and answers in the same order, a line each:
//                           NUMBER 0|1 NANOSECONDS, or NUMBER refused REASON
//   PROGRAM NAME meshes   reads a scene a line:
//                           NUMBER SELF (0 or 1: each object against itself too), then the OBJ
//                           file of each object, whose triangles count from 0
//                         and answers with any number of lines
//                           NUMBER pair OBJECT TRIANGLE OBJECT TRIANGLE
//                         and one more: NUMBER done NANOSECONDS, or NUMBER refused REASON
// Nothing else may be on standard output. The program ends at the end of its input.
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/suite/reader.h"

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
  std::uint64_t memory_mib = 4096;     // of address space that its process may have
  std::string call = {};               // the function that is called, and with what
  std::string says = {};               // what its documentation says of exactness and of touching
  std::string source = {};             // where it says that; others' contestants may leave it out
  std::string use = {};                // where it is the right choice
};

/// Lines `KEY VALUE`, and an empty one at the end. The keys are the names above, but `memory`
/// (MiB); `means` is closed or crossing, and what is true or false is yes or no.
std::string card_text(const ContestantCard& card);
/// Reads what `PROGRAM list` printed. Throws Error naming `where` and the line.
std::vector<ContestantCard> read_cards(std::string_view text, const std::string& where);

/// Thrown by a contestant if its library gives an error instead of an answer, or if its
/// documentation says that it is not made for the question.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Contestant {
  ContestantCard card;  // `pairs` and `meshes` are set by what is not null below
  std::function<bool(const SuitePair&)> pair = {};
  /// The pairs of triangles of the scene that it calls colliding, in any order; all objects are
  /// tested against themselves too, or none is. A triangle with itself is no pair.
  std::function<std::vector<TrianglePair>(const Scene&)> mesh = {};
};

/// main() of a program of contestants: the protocol above. Any exception of a library is a refusal,
/// but for std::bad_alloc, which ends the program. The exit status: 0; 2 for a wrong call or a line
/// that is no question; 3 without memory.
int contest(int argc, char** argv, std::vector<Contestant> contestants);

/// Calls `ask` for every pair of objects, and for each object that is tested against itself with
/// a == b. That is all that a library of two meshes needs.
void for_each_object_pair(const Scene& scene,
                          const std::function<void(const Object& a, const Object& b)>& ask);

/// For libraries that search all objects as one: removes pairs of a triangle with itself, and pairs
/// of an object that is not tested against itself.
void leave_out_untested(const Scene& scene, std::vector<TrianglePair>& pairs);

/// Two triangles as two objects.
Scene two_objects(const SuitePair& pair);
/// The same, but as one object that is tested against itself where they share corners, so that they
/// are neighbours.
Scene scene_of(const SuitePair& pair);

}  // namespace farcull
