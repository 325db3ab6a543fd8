// The protocol of contestants. A contestant of the study "libraries" is a library, called as its
// documentation says, in its own program that reads questions as text and answers them.
//
// Each library has its own program, and is not called by farcull, for three reasons. A library may
// crash, hang or take all memory. Libraries may not be linked together: Bullet exists in float and
// in double under the same names. And a program in any language can take part.
//
// The program is called in one of three ways. Tabulators divide the fields of a line. NUMBER is the
// number of the question, which the answer repeats.
//   PROGRAM list          prints a card for each of its contestants (ContestantCard)
//   PROGRAM NAME pairs    reads lines, each with a pair of triangles:
//                           NUMBER SHARED, then 18 coordinates as decimal numbers that a reader of
//                           doubles gives back exactly; SHARED as in a suite, `-` for none
//                         and answers in the same order, one line for each pair:
//                           NUMBER 0|1 NANOSECONDS, or NUMBER refused REASON
//   PROGRAM NAME meshes   reads lines, each with a scene:
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

/// Which pairs of triangles a library calls colliding, according to its documentation.
enum class Means : std::uint8_t {
  closed,    // closed triangles: touching counts
  crossing,  // triangles that cross; touching and coplanar ones may be called either
};

struct ContestantCard {
  std::string name = {};     // [a-z0-9-]
  std::string library = {};  // name and version, such as "CGAL 5.5.1"
  Means means = Means::closed;
  bool degenerate = true;   // the library takes triangles that are segments or points
  bool neighbours = false;  // it is told which corners two triangles share, and leaves that out
  double margin = 0;  // units: triangles that are no farther apart than this may count as colliding
  bool promises = false;               // only for farcull's methods: a miss breaks a promise
  bool pairs = false, meshes = false;  // which questions it can be asked
  std::uint64_t memory_mib = 4096;     // the most address space of its process
  std::string call = {};               // the function that is called, and its arguments
  std::string says = {};               // what its documentation says of exactness and of touching
  std::string source = {};             // where the documentation says so; others may omit it
  std::string use = {};                // for which purpose it is the right choice
};

/// The card as lines `KEY VALUE`, with an empty line at the end. The keys are the names of the
/// members, but `memory` for memory_mib. `means` is closed or crossing, and a bool is yes or no.
std::string card_text(const ContestantCard& card);
/// Reads what `PROGRAM list` printed. Throws Error naming `where` and the line.
std::vector<ContestantCard> read_cards(std::string_view text, const std::string& where);

/// Thrown by a contestant if its library gives an error instead of an answer, or if the library's
/// documentation says that it is not made for the question.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Contestant {
  ContestantCard card;  // `pairs` and `meshes` are set if the functions below are not null
  std::function<bool(const SuitePair&)> pair = {};
  /// The pairs of triangles of the scene that the library calls colliding, in any order. Either all
  /// objects are tested against themselves too, or none. A triangle with itself is no pair.
  std::function<std::vector<TrianglePair>(const Scene&)> mesh = {};
};

/// main() of a program of contestants: the protocol above. Any exception of a library is a refusal,
/// except std::bad_alloc, which ends the program. The exit status is 0; 2 for a wrong call or a
/// line that is no question; 3 if memory ran out.
int contest(int argc, char** argv, std::vector<Contestant> contestants);

/// Calls `ask` for every pair of objects, and with a == b for each object that is tested against
/// itself. For libraries that test two meshes.
void for_each_object_pair(const Scene& scene,
                          const std::function<void(const Object& a, const Object& b)>& ask);

/// For libraries that search all objects as one: removes pairs of a triangle with itself, and pairs
/// of an object that is not tested against itself.
void leave_out_untested(const Scene& scene, std::vector<TrianglePair>& pairs);

/// Two triangles as two objects.
Scene two_objects(const SuitePair& pair);
/// The same, but if the triangles share corners, as one object that is tested against itself, so
/// that they are neighbours.
Scene scene_of(const SuitePair& pair);

}  // namespace farcull
