// The library: finds exactly all pairs of triangles that collide, between objects and inside them.
//
//   const farcull::Result found = farcull::collide({vertices, triangles, object_starts});
//
// Candidates come from boxes of blocks of triangles (docs/library.md), which miss no pair that
// collides. Exact predicates on the doubles as given decide the candidates. Triangles are closed
// sets, so touching counts. A degenerate triangle counts as a segment or a point. The answer is the
// same for any number of threads.
//
// If a function fails, it throws an Error that says where, why and what to do (error.h), or
// std::bad_alloc if memory runs out. For distances see distance.h, for matrices of Eigen see
// eigen.h.
//
// Link farcull::farcull (CMake: find_package(farcull)) or `pkg-config farcull`. C++20.
#pragma once

#if __cplusplus < 202002L
#error "farcull needs C++20: compile with -std=c++20 (CMake: link farcull::farcull)"
#include "farcull needs C++20"  // a missing file ends the compilation before other errors
#endif

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace farcull {

/// Returns the version of the library, as in "0.1".
const char* version();

/// How much contact detail to report.
enum class Contacts {
  none,      // nothing, at no cost
  kinds,     // Contact::kind
  segments,  // the kind, and the points that the triangles have in common
};

/// A callback that gets the name of the current step. It runs in the caller's thread, at the start
/// and then about every 50 ms. The work runs in another thread. If the callback returns false, the
/// work ends with the error Cancelled. If the callback throws, the work ends with that exception.
using MayGoOn = std::function<bool(const std::string& step)>;

/// The error of a call that MayGoOn cancelled.
class Cancelled : public Error {
 public:
  Cancelled();
};

struct Options {
  unsigned threads = 0;                 // at most 1024; 0: as many as there are cores
  bool self = false;                    // also tests every object against itself
  std::vector<bool> self_objects = {};  // one `self` per object; may be empty
  double clearance = 0;    // pairs at most this far apart collide; world units, finite, >= 0
  bool neighbours = true;  // false: neighbours are counted, but not tested
  Contacts contacts = Contacts::none;
  /// Pairs of different objects that are not tested. Objects are numbered from 0.
  std::vector<std::array<std::uint32_t, 2>> ignore = {};
  std::uint64_t limit = 0;  // finds only this many pairs, the first in the order of Pair;
                            // neighbours count; 0: finds all pairs
  MayGoOn may_go_on = {};
};

/// Moves an object: each of its vertices (x, y, z) becomes the point whose first coordinate is
/// ((r[0] * x + r[1] * y) + r[2] * z) + t[0]; the second coordinate uses r[3] to r[5] and t[1], the
/// third uses r[6] to r[8] and t[2]. Each multiplication and each addition rounds to the nearest
/// double. The answer is exact for the rounded points. r is usually a rotation; it may mirror,
/// scale and shear. A matrix without an inverse, which flattens the object, is refused.
struct Pose {
  std::array<double, 9> r = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  std::array<double, 3> t = {0, 0, 0};
  bool operator==(const Pose&) const = default;
};

/// Triangles, as flat arrays of the caller. The library does not use the arrays after the call.
struct Input {
  /// x, y, z of each vertex; finite if a triangle uses it.
  std::span<const double> vertices = {};
  /// Three indices of vertices for each triangle.
  std::span<const std::uint32_t> triangles = {};
  /// The index of each object's first triangle (not a label for each triangle). The first index is
  /// 0. Each index is larger than the one before. If empty, all triangles are one object.
  std::span<const std::uint32_t> object_starts = {};
  /// The same as `triangles`, with 64-bit indices. If given, `triangles` is empty.
  std::span<const std::int64_t> wide_triangles = {};
  /// One pose for each object. If empty, no object moves. With poses, two objects must not use the
  /// same vertex. If all other arrays are empty, the poses move the last arrays that the same
  /// Collider or DistanceFinder received. A call with bad input discards these arrays.
  std::span<const Pose> poses = {};
};

/// Two triangles, a < b, numbered from 0 in the order of the input.
struct Pair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  auto operator<=>(const Pair&) const = default;
};

/// Returns the object of a triangle. object_starts: as in Input.
inline std::uint32_t object_of(std::span<const std::uint32_t> object_starts,
                               std::uint32_t triangle) {
  const auto after = std::upper_bound(object_starts.begin(), object_starts.end(), triangle);
  return after == object_starts.begin()
             ? 0
             : static_cast<std::uint32_t>(after - object_starts.begin() - 1);
}

/// How the triangles A and B of a pair meet.
struct Contact {
  /// The first kind that fits (docs/record.md, "Kinds of contact").
  enum class Kind {
    apart,         // no point in common, but within the clearance
    equal,         // the same set of points
    touch_vertex,  // one point in common, which is a corner of A or of B
    touch_edge,    // one point in common, which is on an edge of A and on an edge of B
    coplanar,      // in one plane, and more than one point in common
    crossing,      // a point in common that is on no edge of A and on no edge of B
    touch_face,    // a segment in common that is on an edge of A or of B
  };
  Kind kind = Kind::apart;
  /// The dimension of the points in common. 0: a point. 1: a segment. 2: a polygon. -1: there is no
  /// common point, or Options::contacts is not Contacts::segments.
  int dimension = -1;
  /// Dimension 1: the ends of the segment, the lexicographically lower one first. Dimension 0: the
  /// point, twice. Else zeros. World units, each coordinate rounded once.
  std::array<std::array<double, 3>, 2> ends{};
  bool operator==(const Contact&) const = default;
};

/// Returns the name of the kind, as in "touch-vertex".
const char* to_string(Contact::Kind kind);

struct Report {
  struct Stage {
    std::string name;
    bool ran = false;
    std::string reason;  // why the stage ran or was left out
    double ms = 0;
    std::uint64_t in = 0, out = 0;  // numbers of items before and after
    std::string unit;               // what the items are: triangles or pairs
  };

  double candidates_ms = 0;      // wall clock, from the input to the candidates
  double exact_ms = 0;           // wall clock of the exact tests
  std::uint64_t candidates = 0;  // pairs of triangles, except pairs of ignored objects
  std::uint64_t decided = 0;  // candidates that exact tests decided; fewer than `candidates` if the
                              // limit was reached first
  std::uint64_t neighbours = 0;   // decided candidates that are neighbours, colliding or not
  double contacts_ms = 0;         // wall clock of finding the kinds of contact
  std::uint64_t passed_over = 0;  // vertices that are not finite and that no triangle uses
  std::vector<Stage> stages;

  /// The floating-point environment of the calling thread, as in "rounds upward, keeps subnormals".
  /// Empty if that thread rounds to nearest and keeps subnormals.
  std::string callers_arithmetic;
};

struct Result {
  std::vector<Pair> pairs;  // all colliding pairs except neighbours, sorted, each once
  /// Colliding neighbours, sorted. Neighbours are triangles of one object that share a vertex
  /// position. They collide if they have a common point that is neither a shared position nor on a
  /// shared edge. Empty without Options::neighbours.
  std::vector<Pair> neighbour_pairs;
  std::vector<Contact> contacts;            // one for each of `pairs`, or none
  std::vector<Contact> neighbour_contacts;  // one for each of `neighbour_pairs`, or none
  /// False: Options::limit ended the search, so more pairs may follow the last one. No pair before
  /// the last one is missing.
  bool complete = true;
  Report report;
};

/// Finds the colliding pairs of one input. Throws as Collider does.
Result collide(const Input& input, const Options& options = {});

/// Finds colliding pairs repeatedly. Between calls, a Collider keeps buffers, and results about
/// triangles that did not move. Any thread may call find(), but only one call may run at a time: a
/// second call throws Error and changes nothing. A call of a moved-from Collider also throws Error.
/// While a Collider is moved or destroyed, no other thread may use the Collider.
class Collider {
 public:
  /// Throws Error naming the option that is bad.
  explicit Collider(const Options& options);
  Collider();  // default options
  ~Collider();
  Collider(Collider&&) noexcept;
  Collider& operator=(Collider&&) noexcept;

  /// Throws Cancelled if Options::may_go_on returns false. Throws Error if
  /// - the input breaks a condition that Input states,
  /// - there is nothing to test: one object without `self`, or fewer than two triangles,
  /// - self_objects is not empty, and its size is not the number of objects,
  /// - an ignored object does not exist.
  /// The Collider can be used again after an exception. find() sets the floating-point environment
  /// of the calling thread (rounding, flushing, traps) and restores it at the end.
  Result find(const Input& input);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace farcull
