// The library: finds exactly all pairs of triangles that collide, between objects and inside them.
//
// Candidates come from FAR pairs (docs/library.md). If ColliderReport::promises is true, FAR pairs
// misses no pair that collides. Exact predicates on the doubles as given decide the candidates.
// Triangles are closed sets, so touching counts, and a degenerate triangle is the segment or the
// point that it is. If `promises` is true, the answer is the same on every device, for any number
// of threads, views and pixels: these change only the time.
//
// Link farcull::farcull (CMake: find_package(farcull)) or `pkg-config farcull`. C++20.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace farcull {

/// Thrown for bad input and for faults of a device, instead of an answer; what() has the whole
/// message.
class ColliderError : public std::runtime_error {
 public:
  ColliderError(const std::string& what, std::string where, std::string reason, std::string remedy);

  std::string where;   // "vertices", "triangles", "object_starts", an option, an object of the
                       // library, or a step on a device
  std::string reason;  // what is wrong there
  std::string remedy;  // what to do next
};

enum class ColliderDevice {
  cpu,   // threads
  gl,    // OpenGL 4.3 without a window, through EGL: hardware first, then a software renderer
  best,  // the CPU if boxes of runs decide (docs/methods.md), else gl if a hardware device answers,
         // else the CPU; the report says which, and why
};

/// How much contact detail to report.
enum class ColliderContacts {
  none,      // nothing, at no cost
  kinds,     // ColliderContact::kind
  segments,  // the kind, and the points that the triangles have in common
};

struct ColliderOptions {
  ColliderDevice device = ColliderDevice::cpu;
  unsigned threads = 0;  // up to 1024, for the exact tests as well; 0: as many as there are cores
  bool self = false;     // every object is tested against itself as well
  std::vector<bool> self_objects = {};  // `self` for each object; empty, or one for each
  double clearance = 0;    // pairs at this distance or less collide too; world units, finite, >= 0
  bool neighbours = true;  // false: neighbours are counted, not decided
  ColliderContacts contacts = ColliderContacts::none;
  /// Pairs of different objects, by their numbers from 0, that are not tested against each other.
  std::vector<std::array<std::uint32_t, 2>> ignore = {};
  std::uint64_t limit = 0;     // only the first so many pairs, neighbours included, in the order of
                               // ColliderPair; 0: all
  std::string views = "auto";  // directions to look along, as in "x,-y,1:1:0.5"; auto: by the scene
  int resolution = 0;          // px along a view's larger side, 1 to 16384; 0: by the scene
};

/// Triangles, as flat arrays of the caller. The library does not refer to them after the call.
struct ColliderInput {
  std::span<const double> vertices;              // x, y, z of each vertex; finite if a triangle
                                                 // uses it
  std::span<const std::uint32_t> triangles;      // three indices of vertices for each triangle
  std::span<const std::uint32_t> object_starts;  // the first triangle of each object, no label for
                                                 // each triangle: 0, then rising, so that each has
                                                 // a triangle; empty: all are one object
  std::span<const std::int64_t> wide_triangles = {};  // the indices as 64-bit numbers, in place of
                                                      // `triangles`, which is then empty
};

/// Two triangles, a < b, numbered from 0 in the order of the input.
struct ColliderPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  auto operator<=>(const ColliderPair&) const = default;
};

/// How two triangles A and B meet: the first kind that fits (docs/methods.md, "Kinds of contact").
enum class ColliderContactKind {
  apart,         // no point in common, and within the clearance
  equal,         // the same set of points
  touch_vertex,  // one point in common, which is a corner of A or of B
  touch_edge,    // one point in common, which is on an edge of A and on an edge of B
  coplanar,      // in one plane, and more than one point in common
  crossing,      // a point in common that is on no edge of A and on no edge of B
  touch_face,    // a segment in common that is on an edge of A or of B
};

/// "touch-vertex" and so on.
const char* to_string(ColliderContactKind kind);

struct ColliderContact {
  ColliderContactKind kind = ColliderContactKind::apart;
  /// With ColliderContacts::segments, the dimension of the points in common: 0 a point, 1 a
  /// segment, 2 a polygon; -1 none, or not asked.
  int dimension = -1;
  /// Dimension 1: the ends of the segment, the lexicographically lower one first. Dimension 0: the
  /// point, twice. Else zeros. World units, each coordinate rounded once.
  std::array<std::array<double, 3>, 2> ends{};
  bool operator==(const ColliderContact&) const = default;
};

struct ColliderReport {
  struct Stage {
    std::string name;
    bool ran = false;
    std::string reason;  // why the stage ran or was left out
    double ms = 0;
    std::uint64_t in = 0, out = 0;  // how many items entered, and how many were left
    std::string unit;               // what the items are: triangles, views or pairs
  };
  struct View {
    std::string name;           // as in ColliderOptions::views
    bool looked = false;        // false: pixels cannot resolve the scene in this direction
    std::string reason;         // why this direction and this resolution
    int width = 0, height = 0;  // px
  };

  std::string device;            // "cpu", or the renderer
  std::string device_reason;     // why this device
  bool promises = false;         // a pair that collides is never left out; false if a probe of an
                                 // assumption fails on the device, or broke off
  std::string promises_reason;   // why, or why not
  double candidates_ms = 0;      // wall clock, from the input to the candidates
  double exact_ms = 0;           // wall clock of the exact tests
  std::uint64_t candidates = 0;  // without those of ignored objects
  std::uint64_t decided = 0;  // candidates that exact tests decided; fewer than `candidates` if the
                              // limit was reached first
  std::uint64_t neighbours = 0;   // decided candidates that are neighbours, colliding or not
  double contacts_ms = 0;         // wall clock of the kinds of contact
  std::uint64_t passed_over = 0;  // vertices that are not finite and that no triangle uses
  std::vector<View> views;
  std::vector<Stage> stages;

  /// The floating-point environment of the calling thread, as in "rounds upward, keeps subnormals";
  /// empty if it rounds to nearest and keeps subnormals, as the call itself always does.
  std::string callers_arithmetic;
};

struct ColliderResult {
  std::vector<ColliderPair> pairs;  // all that collide and are no neighbours, sorted, each once; of
                                    // different objects, or of one that is tested against itself
  /// Colliding neighbours: triangles of one object that share a vertex position, and whose
  /// intersection is more than the shared positions and the edge between them. Sorted; empty
  /// without ColliderOptions::neighbours.
  std::vector<ColliderPair> neighbour_pairs;
  std::vector<ColliderContact> contacts;            // one for each of `pairs`, and one for each
  std::vector<ColliderContact> neighbour_contacts;  // of `neighbour_pairs`; empty without
                                                    // ColliderOptions::contacts
  /// False: ColliderOptions::limit ended the search, so there may be more pairs after the last one.
  /// No pair before the last one is missing.
  bool complete = true;
  ColliderReport report;
};

/// Finds colliding pairs again and again: buffers, threads' memory, the GL context and its programs
/// stay from call to call. An object serves one call at a time, from any thread. A second call at
/// the same time, or a call of an object that was moved from, throws ColliderError and changes
/// nothing. Moving and destroying are not protected: no other thread may use the object then. The
/// EGL context that was current in the caller is current again after each call.
class Collider {
 public:
  /// Opens the device. A GL device without a kept verdict is probed, which takes about a second
  /// on Mesa llvmpipe, and several seconds if Mesa's cache of shaders is empty (docs/library.md).
  /// Throws ColliderError naming the option that is bad, or if the device does not answer.
  explicit Collider(const ColliderOptions& options);
  Collider();  // default options
  ~Collider();
  Collider(Collider&&) noexcept;
  Collider& operator=(Collider&&) noexcept;

  /// Throws ColliderError for input that is not as ColliderInput says, for input in which there is
  /// nothing to test (one object without `self`, or fewer than two triangles), for a self_objects
  /// that does not have one value for each object, for ignored objects that the input does not
  /// have, and for any fault of the device; std::bad_alloc if memory runs out. The object can be
  /// used again after each of these. The calling thread may round in any direction and flush
  /// subnormals: the call sets its floating-point environment (rounding, flushing, traps) and
  /// restores it at the end.
  ColliderResult find(const ColliderInput& input);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A pair that ColliderStream finds.
struct ColliderFound {
  ColliderPair pair;
  bool neighbours = false;  // the triangles are of one object and share a vertex position
  ColliderContact contact;  // set if ColliderOptions::contacts asks for it
  bool operator==(const ColliderFound&) const = default;
};

/// Gives the pairs of Collider::find(), colliding neighbours included, a part at a time, in the
/// order of ColliderPair. For more pairs than memory holds, or to have the first pairs early.
///
///   ColliderStream stream(input, options);
///   std::vector<ColliderFound> pairs;
///   while (stream.next(pairs)) use(pairs);
///
/// Memory O(triangles), whatever the number of pairs. A stream compares boxes of triangles on the
/// cores of the CPU, so it finds every pair that collides. It is slower than a Collider if nearly
/// all pairs are wanted. An object serves one call at a time, as a Collider does.
class ColliderStream {
 public:
  /// Copies the input. Throws ColliderError as Collider::find(), and for device gl, which a stream
  /// does not use. Ignores the options views and resolution.
  explicit ColliderStream(const ColliderInput& input, const ColliderOptions& options = {});
  ~ColliderStream();
  ColliderStream(ColliderStream&&) noexcept;
  ColliderStream& operator=(ColliderStream&&) noexcept;

  /// Replaces `pairs` by the next pairs. There may be none even before the end. Returns false at
  /// the end, with `pairs` empty. Each call decides at most about 2^16 candidates and those of one
  /// more triangle for each thread, so that the caller can stop between two calls. Throws
  /// std::bad_alloc if memory runs out; each later call then throws ColliderError.
  bool next(std::vector<ColliderFound>& pairs);
  /// The number of candidates that exact tests decided in the calls that have ended. Unlike the
  /// pairs, this number may depend on the number of threads.
  std::uint64_t decided() const;
  /// After the end: ColliderResult::complete. If exactly as many pairs collide as the limit allows,
  /// it may depend on the number of threads.
  bool complete() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Distances (docs/proximity.md). Each is exact: the root of a rational number, rounded once, and no
// nearer pair of triangles exists.

enum class DistanceKind {
  objects,  // the nearest triangles of every two objects, and within each object with `self`
  nearest,  // those of each object and its k nearest other objects; of ties, the lower comes first
  all,      // every pair of triangles within a distance
};

struct DistanceFinderOptions {
  DistanceKind kind = DistanceKind::objects;
  std::size_t k = 1;   // with `nearest`, 1 or more
  double within = -1;  // leaves out answers that are farther apart; world units; negative: no
                       // limit. Finite and 0 or more with `all`
  bool self = false;   // also triangles of one object, without neighbours; not with `nearest`
  std::vector<bool> self_objects = {};  // `self` for each object; empty, or one for each
  bool inside = true;                   // find whether an object is inside another; not with `all`
  unsigned threads = 0;  // up to 1024; 0: as many as there are cores; changes no answer
};

/// Which of two objects is inside the other. unknown: not asked, or the objects meet. none: neither
/// is. a, b: all of this object is inside the other. not_closed: one may be inside the other, but
/// the other is not closed, so it has no inside.
enum class DistanceInside { unknown, none, a, b, not_closed };

/// The distance of two objects, or with `all` of two triangles.
struct DistanceAnswer {
  std::uint32_t object_a = 0, object_b = 0;      // a <= b
  std::uint32_t triangle_a = 0, triangle_b = 0;  // numbered as in ColliderPair; the first of the
                                                 // nearest pairs
  double distance = 0;  // rounded to nearest; infinity beyond the largest double
  std::string squared;  // "numerator/denominator" in lowest terms, nothing rounded
  std::array<double, 3> point_a{}, point_b{};  // nearest points, each coordinate rounded
  std::string feature_a, feature_b;  // where the points lie: "vertex 2", "edge 0" or "face"; edge i
                                     // goes from corner i to the next
  DistanceInside inside = DistanceInside::unknown;
};

/// Finds distances again and again. The nearest triangles of one call are the first guess of the
/// next call, which saves time if the scene moved only a little; any other scene may follow, too.
/// An object serves one call at a time, as a Collider does.
class DistanceFinder {
 public:
  /// Throws ColliderError naming the option that is bad.
  explicit DistanceFinder(const DistanceFinderOptions& options);
  DistanceFinder();  // default options
  ~DistanceFinder();
  DistanceFinder(DistanceFinder&&) noexcept;
  DistanceFinder& operator=(DistanceFinder&&) noexcept;

  /// The answers, sorted by objects, then by triangles. Throws ColliderError for input that is not
  /// as ColliderInput says or has nothing to ask about, as Collider::find(), for a
  /// self_objects that does not have one value for each object, if `all` has more than 4,194,304
  /// answers, and if `objects` has more pairs of objects than that (four times as many if `within`
  /// is finite); std::bad_alloc if memory runs out. Sets and restores the floating-point
  /// environment as Collider::find() does.
  std::vector<DistanceAnswer> find(const ColliderInput& input);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// DistanceFinder::find() for one scene.
std::vector<DistanceAnswer> distances(const ColliderInput& input,
                                      const DistanceFinderOptions& options = {});

}  // namespace farcull
