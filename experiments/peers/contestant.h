// A contestant is a library, called as its documentation says, in a program that reads questions as
// text and answers them. docs/ask.md has the protocol; this is the side that answers, in C++.
// `PROGRAM NAME` is the contestant NAME of the program.
//
// Each library has its own program, and is not called by farcull, for three reasons. A library may
// crash, hang or take all memory. Libraries may not be linked together: Bullet exists in float and
// in double under the same names. And a program in any language can take part.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>

#include "experiments/suite/label.h"

namespace farcull {

/// Which pairs of triangles a library calls colliding, according to its documentation.
enum class Means : std::uint8_t {
  closed,    // closed triangles: touching counts
  crossing,  // triangles that cross; for touching and coplanar ones both answers are right
};

struct ContestantCard {
  std::string name = {};     // [a-z0-9-]
  std::string library = {};  // name and version, such as "CGAL 5.5.1"
  Means means = Means::closed;
  bool degenerate = true;   // the library takes triangles that are segments or points
  bool neighbours = false;  // can be told which corners two triangles share, and ignores these
  double margin = 0;  // units: triangles that are no farther apart than this may count as colliding
  bool guaranteed = false;  // only for farcull's methods: a miss breaks the guarantee
  // For libraries of the study these texts are in experiments/report/chapters/libraries.csv.
  std::string call = {};    // the function that is called, and its arguments
  std::string says = {};    // what its documentation says of exactness and of touching
  std::string source = {};  // where the documentation says so; may be empty
  std::string use = {};     // for which purpose it is the right choice
};

/// The card of a library that promises only pairs that cross, and takes no degenerate triangles.
ContestantCard crossing_card(const std::string& name, const std::string& library);

/// Thrown by a contestant if its library gives an error instead of an answer, or if the library's
/// documentation says that it is not made for the question.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The distance of two triangles, and a point of each at that distance if the library gives one.
struct ContestDistance {
  double distance = 0;
  std::optional<std::array<Vec3, 2>> points = {};
};

struct Contestant {
  ContestantCard card;
  // The questions that it answers: the functions that are not null.
  std::function<bool(const SuitePair&)> pair = {};
  /// The pairs of triangles of the scene that the library calls colliding, in any order. Either all
  /// objects are tested against themselves too, or none. A triangle with itself is no pair.
  std::function<std::vector<TrianglePair>(const Scene&)> mesh = {};
  std::function<ContestDistance(const SuitePair&)> distance = {};
  // The other questions. The scene has: for `self` one object, which is tested against itself; for
  // `inside` one closed object; for `clash` two closed objects.
  std::function<bool(const Scene&)> self = {};
  std::function<bool(const Scene&, const Vec3&)> inside = {};
  std::function<bool(const Scene&)> clash = {};
};

/// main() of a program of contestants: the protocol of docs/ask.md. Any exception of a library is a
/// refusal, except std::bad_alloc, which ends the program. The exit status is 0; 2 for a wrong call
/// or a line that is not a question; 3 if memory ran out.
int contest(int argc, char** argv, const std::vector<Contestant>& contestants);

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
