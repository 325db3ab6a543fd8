// A contestant is a library that answers questions in a program of its own. The program reads
// questions as text and calls the library as the library's documentation says. docs/ask.md defines
// the protocol. Such programs use this header. `PROGRAM NAME` runs the contestant NAME.
//
// farcull does not call the libraries itself, for three reasons. A library may crash, hang or take
// all memory. Some libraries cannot be linked together: Bullet in float and Bullet in double have
// the same names. A program in any language can take part.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>

#include "experiments/suite/label.h"

namespace farcull {

/// Which pairs of triangles a library reports, according to its documentation.
enum class Means : std::uint8_t {
  closed,    // closed triangles: touching counts
  crossing,  // triangles that cross; for touching or coplanar triangles any answer is right
};

struct ContestantCard {
  std::string name = {};     // [a-z0-9-]
  std::string library = {};  // name and version, such as "CGAL 5.5.1"
  Means means = Means::closed;
  bool degenerate = true;   // the library accepts triangles that are segments or points
  bool neighbours = false;  // the library ignores corners that two triangles share
  double margin = 0;        // world units; the library may report triangles this far apart
  bool guaranteed = false;  // only for farcull's methods: a miss breaks the guarantee
  // For other libraries, experiments/report/chapters/libraries.csv has the following texts.
  std::string call = {};    // the function that is called, and its arguments
  std::string says = {};    // what the documentation says about exactness and touching
  std::string source = {};  // where the documentation says this; may be empty
  std::string use = {};     // purpose for which the library is the right choice
};

/// Returns the card of a library that guarantees only crossing pairs and accepts no degenerate
/// triangles.
ContestantCard crossing_card(const std::string& name, const std::string& library);

/// Thrown by a contestant if its library reports an error, or if the library's documentation says
/// that the library is not made for the question.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The distance of two triangles, and the two nearest points if the library gives them.
struct ContestDistance {
  double distance = 0;
  std::optional<std::array<Vec3, 2>> points = {};
};

struct Contestant {
  ContestantCard card;
  // Each function answers one kind of question; null: the library does not answer this kind.
  std::function<bool(const SuitePair&)> pair = {};
  /// Returns the pairs of triangles that the library reports, in any order, without pairs of a
  /// triangle with itself. In a scene, either all objects are tested against themselves or none.
  std::function<std::vector<TrianglePair>(const Scene&)> mesh = {};
  std::function<ContestDistance(const SuitePair&)> distance = {};
  // The scene of `self` has one object, which is tested against itself. The scene of `inside` has
  // one closed object. The scene of `clash` has two closed objects.
  std::function<bool(const Scene&)> self = {};
  std::function<bool(const Scene&, const Vec3&)> inside = {};
  std::function<bool(const Scene&)> clash = {};
};

/// The main() of a contestants' program, with the protocol of docs/ask.md. An exception of a
/// library becomes a refusal, but std::bad_alloc ends the program. Returns the exit status. 0: no
/// error. 2: a wrong call, or a line that is not a question. 3: memory ran out.
int contest(int argc, char** argv, const std::vector<Contestant>& contestants);

/// Calls `ask` for every pair of objects. For an object that is tested against itself, calls `ask`
/// with a == b.
void for_each_object_pair(const Scene& scene,
                          const std::function<void(const Object& a, const Object& b)>& ask);

/// Removes pairs of a triangle with itself, and pairs inside an object that is not tested against
/// itself. Needed for libraries that search all objects as one mesh.
void leave_out_untested(const Scene& scene, std::vector<TrianglePair>& pairs);

/// Returns a scene with the two triangles as two objects.
Scene two_objects(const SuitePair& pair);
/// If the triangles share corners, returns a scene with one object that is tested against itself.
/// In this scene the triangles are neighbours. Else returns two_objects(pair).
Scene scene_of(const SuitePair& pair);

}  // namespace farcull
