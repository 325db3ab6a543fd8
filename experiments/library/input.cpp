// Checks and copies input into a scene; converts options and answers.
#include "experiments/library/input.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "experiments/method/distances.h"

namespace farcull {
namespace {

constexpr std::size_t kBlock = 1536;  // numbers in a block, a multiple of 3; fits into the L1 cache

static_assert(sizeof(Vec3) == 3 * sizeof(double));
static_assert(sizeof(std::array<std::uint32_t, 3>) == 3 * sizeof(std::uint32_t));

// True if no number is infinite or NaN. The exponent bits of infinity and NaN are all ones. Adding
// one to such an exponent sets the sign bit. The loop has no branch, so that the compiler can
// vectorize it.
bool all_finite(std::span<const double> block) {
  constexpr std::uint64_t kExponent = 0x7FF0'0000'0000'0000, kOne = 0x0010'0000'0000'0000;
  std::uint64_t bits = 0;
  for (const double x : block) bits |= (std::bit_cast<std::uint64_t>(x) & kExponent) + kOne;
  return bits >> 63 == 0;
}

// Converts indices. Returns true if all indices are at least 0 and below `vertices`. A 64-bit index
// that is negative or too large for 32 bits has a bit set in its upper half.
template <class Index>
bool convert(std::span<const Index> from, std::uint32_t* to, std::size_t vertices) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const auto wide = static_cast<std::uint64_t>(from[k]);
    bits |= wide;
    to[k] = static_cast<std::uint32_t>(wide);
  }
  std::uint32_t most = 0;
  for (std::size_t k = 0; k < from.size(); ++k) most = std::max(most, to[k]);
  return bits >> 32 == 0 && most < vertices;
}

// Appends the numbers of the vertices whose bits differ between the blocks a and b. The blocks have
// `size` doubles and begin at vertex `first`.
void append_moved(const double* a, const double* b, std::size_t size, std::size_t first,
                  std::vector<std::uint32_t>& out) {
  std::size_t next = out.size();
  out.resize(next + size / 3);
  const auto differ = [&](std::size_t k) {
    return std::bit_cast<std::uint64_t>(a[k]) ^ std::bit_cast<std::uint64_t>(b[k]);
  };
  for (std::size_t k = 0; k < size; k += 3) {  // no branch, which would often be mispredicted
    out[next] = static_cast<std::uint32_t>(first + k / 3);
    next += (differ(k) | differ(k + 1) | differ(k + 2)) != 0;
  }
  out.resize(next);
}

// Copies the vertices. Checks the copies, not the input, since another thread may change the input
// during the call. The old contents of `to` were checked before, so equal blocks need no check. A
// vertex that is not finite becomes 0, 0, 0 and is listed in `bad`. change: receives the vertices
// that changed; may be null.
void copy_vertices(std::span<const double> from, std::vector<Vec3>& to, FrameChange* change,
                   std::vector<std::uint32_t>& bad) {
  const std::size_t before = 3 * to.size();
  to.resize(from.size() / 3);
  if (from.empty()) return;
  double* const copies = to[0].data();
  std::array<double, kBlock> block;
  for (std::size_t begin = 0; begin < from.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, from.size()), size = end - begin;
    const std::size_t bytes = size * sizeof(double);
    const bool known = end <= before;
    if (known && std::memcmp(copies + begin, from.data() + begin, bytes) == 0) continue;
    std::memcpy(block.data(), from.data() + begin, bytes);
    if (known && change)
      append_moved(block.data(), copies + begin, size, begin / 3, change->vertices);
    std::memcpy(copies + begin, block.data(), bytes);
    if (all_finite({copies + begin, copies + end})) continue;
    for (std::size_t k = begin; k < end; k += 3) {
      if (all_finite({copies + k, copies + k + 3})) continue;
      bad.push_back(static_cast<std::uint32_t>(k / 3));
      std::fill(copies + k, copies + k + 3, 0.0);
    }
  }
}

// Throws Error if a triangle uses a vertex of `bad`. vertices: the number of all vertices.
void require_unused(const std::vector<std::uint32_t>& bad, std::size_t vertices,
                    const Scene& scene) {
  if (bad.empty()) return;
  std::vector<bool> is_bad(vertices);
  for (const std::uint32_t v : bad) is_bad[v] = true;
  std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
  for (const auto& triangle : scene.triangles) {
    for (const std::uint32_t v : triangle) first = is_bad[v] ? std::min(first, v) : first;
  }
  if (first == std::numeric_limits<std::uint32_t>::max()) return;
  throw Error("vertices", "vertex " + std::to_string(first) + " is not finite",
              "give finite coordinates to each vertex that a triangle uses");
}

// Copies triangles. Returns true if none changed. checked: indices in `to` are below `vertices`.
template <class Index>
bool copy_triangles(std::span<const Index> from, std::size_t vertices, bool checked,
                    std::vector<std::array<std::uint32_t, 3>>& to) {
  const std::size_t before = checked ? 3 * to.size() : 0;
  bool same = before == from.size();
  to.resize(from.size() / 3);
  if (from.empty()) return same;
  std::uint32_t* const copies = to[0].data();
  std::array<std::uint32_t, kBlock> converted;
  for (std::size_t begin = 0; begin < from.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, from.size()), size = end - begin;
    const auto is_there = [&](const void* numbers) {
      return end <= before && std::memcmp(copies + begin, numbers, 4 * size) == 0;
    };
    if (sizeof(Index) == 4 && is_there(from.data() + begin)) continue;
    const bool good = convert(from.subspan(begin, size), converted.data(), vertices);
    if (sizeof(Index) > 4 && good && is_there(converted.data())) continue;
    same = false;
    if (good) {
      std::memcpy(copies + begin, converted.data(), 4 * size);
      continue;
    }
    for (std::size_t k = begin; k < end; ++k) {
      const Index v = from[k];
      copies[k] = static_cast<std::uint32_t>(v);
      if (v >= 0 && static_cast<std::uint64_t>(v) < vertices) continue;
      throw Error("triangles",
                  "triangle " + std::to_string(k / 3) + " names vertex " + std::to_string(v) +
                      " of " + std::to_string(vertices),
                  "correct the index");
    }
  }
  return same;
}

// Throws Error if an object has no triangle, so that labels of triangles, such as 0, 0, 1, 1, are
// not mistaken for first triangles.
void require_starts(std::span<const std::uint32_t> starts, std::size_t triangles) {
  for (std::size_t o = 0; o < starts.size(); ++o) {
    const bool rises = o == 0 ? starts[0] == 0 : starts[o] > starts[o - 1];
    if (rises && starts[o] < triangles) continue;
    std::string reason = "object " + std::to_string(o) + " starts at triangle " +
                         std::to_string(starts[o]) + " of " + std::to_string(triangles);
    if (!rises && o > 0) reason += ", and the object before it at " + std::to_string(starts[o - 1]);
    const std::string labels =
        ". A label for each triangle is no list of starts: sort the triangles by label and give "
        "where each label begins (Python: give labels=)";
    throw Error("object_starts", reason,
                "give the first triangle of each object: 0, then rising numbers below the number "
                "of triangles" +
                    (rises ? "" : labels));
  }
}

// Throws Error if no pair can be tested: an empty answer would look like a scene without
// collisions.
void require_pairs(const Scene& scene) {
  if (const std::string reason = nothing_asked(scene, {}); !reason.empty())
    throw Error("object_starts", reason + ", so there is nothing to test",
                "give the first triangle of each of two objects or more, or test the object "
                "against itself with self");
}

// Copies the vertices to `copies`, and all other arrays into the scene. Returns true if the number
// of vertices, the triangles and the objects are the same as before.
bool copy(const Input& input, bool self, const std::vector<bool>& self_objects, TakenInput& taken,
          std::vector<Vec3>& copies, FrameChange* change, bool asked) {
  Scene& scene = taken.scene;
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (input.vertices.size() % 3 != 0 || input.vertices.size() / 3 > kMost)
    throw Error("vertices", "are not three doubles for each of at most 2^32 - 1 vertices",
                "give x, y, z of each");
  if (!input.triangles.empty() && !input.wide_triangles.empty())
    throw Error("triangles", "are given twice", "give triangles or wide_triangles");
  const std::size_t indices = input.triangles.size() + input.wide_triangles.size();
  if (indices % 3 != 0 || indices / 3 > kMost)
    throw Error("triangles", "are not three indices for each of at most 2^32 - 1 triangles",
                "give three indices of each");
  const auto count = static_cast<std::uint32_t>(indices / 3);
  const std::size_t vertices = input.vertices.size() / 3;
  bool same = scene.vertices.size() == vertices;
  std::vector<std::uint32_t> bad;
  copy_vertices(input.vertices, copies, change, bad);
  if (input.wide_triangles.empty()) {
    same = copy_triangles(input.triangles, vertices, same, scene.triangles) && same;
  } else {
    same = copy_triangles(input.wide_triangles, vertices, same, scene.triangles) && same;
  }
  require_unused(bad, vertices, scene);
  if (const unsigned least = asked ? 2 : input.object_starts.empty() ? 0 : 1; count < least)
    throw Error("triangles", "are " + std::to_string(count) + ", so there is nothing to test",
                "give " + std::to_string(least) + " or more");
  taken.passed_over = bad.size();
  scene.source_face.resize(count);
  const std::size_t objects = std::max<std::size_t>(input.object_starts.size(), 1);
  if (!self_objects.empty() && self_objects.size() != objects) {
    throw Error("self_objects",
                "are " + std::to_string(self_objects.size()) + " for " + std::to_string(objects) +
                    " objects",
                "give one for each object, or none");
  }
  require_starts(input.object_starts, count);
  same = same && scene.objects.size() == objects;
  scene.objects.resize(objects);
  for (std::size_t o = 0; o < objects; ++o) {
    const std::uint32_t first = input.object_starts.empty() ? 0 : input.object_starts[o];
    const std::uint32_t end = o + 1 < objects ? input.object_starts[o + 1] : count;
    Object& object = scene.objects[o];
    const bool of_self = self || (!self_objects.empty() && self_objects[o]);
    same = same && object.first_triangle == first && object.triangle_count == end - first &&
           object.self == of_self;
    object.first_triangle = first;
    object.triangle_count = end - first;
    object.self = of_self;
  }
  if (asked) require_pairs(scene);
  return same;
}

std::vector<std::uint32_t> objects_of_vertices(const Scene& scene, std::size_t vertices) {
  std::vector<std::uint32_t> out(vertices, kNoObject);
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      for (const std::uint32_t v : scene.triangles[object.first_triangle + k]) {
        const std::uint32_t other = std::exchange(out[v], o);
        if (other == kNoObject || other == o) continue;
        throw Error("poses",
                    "vertex " + std::to_string(v) + " is used by objects " + std::to_string(other) +
                        " and " + std::to_string(o) + ", which have a pose each",
                    "give each object vertices of its own");
      }
    }
  }
  return out;
}

void require_good(std::span<const Pose> poses, std::size_t objects) {
  if (poses.size() != objects)
    throw Error(
        "poses",
        "are " + std::to_string(poses.size()) + " for " + std::to_string(objects) + " objects",
        "give one for each object, or none");
  for (std::size_t o = 0; o < objects; ++o) {
    if (!all_finite(poses[o].r) || !all_finite(poses[o].t))
      throw Error("poses", "that of object " + std::to_string(o) + " is not finite",
                  "give finite numbers");
    if (!is_invertible(poses[o].r))
      throw Error(
          "poses",
          "the matrix of object " + std::to_string(o) + " has no inverse, so it flattens it",
          "give a rotation, or another matrix whose determinant is not 0");
  }
}

RigidMotion motion_of(const Pose& pose) { return {pose.r, pose.t}; }

// Moves the vertices of objects whose pose has changed since the last call. If `all` is true, moves
// all vertices.
void move(std::span<const Pose> poses, bool all, TakenInput& taken, FrameChange* change) {
  std::vector<bool> moves(poses.size(), true);
  for (std::size_t o = 0; o < poses.size() && !all; ++o) moves[o] = poses[o] != taken.poses[o];
  std::vector<RigidMotion> motions(poses.size());
  std::ranges::transform(poses, motions.begin(), motion_of);
  taken.scene.vertices.resize(taken.unmoved.size(), Vec3::Zero());
  for (std::uint32_t v = 0; v < taken.unmoved.size(); ++v) {
    const std::uint32_t o = taken.object_of[v];
    if (o != kNoObject && !moves[o]) continue;
    const Vec3 to = o == kNoObject ? taken.unmoved[v] : moved(motions[o], taken.unmoved[v]);
    Vec3& at = taken.scene.vertices[v];
    if (std::memcmp(at.data(), to.data(), sizeof(Vec3)) == 0) continue;
    if (!all_finite({to.data(), 3}))
      throw Error("poses",
                  "that of object " + std::to_string(o) + " moves vertex " + std::to_string(v) +
                      " beyond the largest double",
                  "give a pose with smaller numbers");
    at = to;
    if (change) change->vertices.push_back(v);
  }
  taken.poses.assign(poses.begin(), poses.end());
  taken.stale = false;
}

bool are_alone(const Input& input) {
  return input.vertices.empty() && input.triangles.empty() && input.wide_triangles.empty() &&
         input.object_starts.empty();
}

// Returns true if load_poses() is faster than load_input(). triangles: the number of triangles in
// overlapping blocks, which load_poses() tests. of_moved: the number of triangles that moved.
//
// If the results of the last call are kept, load_input() tests only the triangles that moved. Else
// load_input() tests all triangles once, and in later calls only the triangles that moved. So each
// call of load_poses() loses the time of `triangles` - `of_moved` triangles. load_poses() is used
// until these losses add up to the number of all triangles.
bool pays(std::uint64_t triangles, std::uint64_t of_moved, bool keeps_frames, TakenInput& taken) {
  if (keeps_frames) return triangles < of_moved;
  const auto all = static_cast<double>(taken.scene.triangles.size());
  const auto cost = static_cast<double>(triangles);
  taken.loss += std::max(0.0, cost - static_cast<double>(of_moved));
  return cost < all && taken.loss < all;
}

// Copies input that has poses, and moves the vertices. Returns the result of copy().
bool copy_posed(const Input& input, bool self, const std::vector<bool>& self_objects,
                TakenInput& taken, FrameChange* change, bool asked) {
  const bool alone = are_alone(input);
  const bool had_poses = !taken.poses.empty();
  bool same = true;
  if (!alone) {
    taken.rigid.reset();
    same = copy(input, self, self_objects, taken, taken.unmoved, nullptr, asked);
  } else if (taken.scene.objects.empty()) {
    throw Error("poses", "are given without triangles, and there are none of an earlier call",
                "give vertices, triangles and object_starts with them");
  } else if (!had_poses) {
    taken.unmoved = taken.scene.vertices;
  }
  require_good(input.poses, taken.scene.objects.size());
  if (!same || !had_poses) taken.object_of = objects_of_vertices(taken.scene, taken.unmoved.size());
  move(input.poses, !alone || !had_poses || taken.stale, taken, change);
  return same;
}

// The enumerations of farcull.h have the same values as the internal enumerations.
static_assert([] {
  using Given = Contact::Kind;
  using Own = ContactKind;
  return same(Given::apart, Own::apart) && same(Given::equal, Own::equal) &&
         same(Given::touch_vertex, Own::touch_vertex) && same(Given::touch_edge, Own::touch_edge) &&
         same(Given::coplanar, Own::coplanar) && same(Given::crossing, Own::crossing) &&
         same(Given::touch_face, Own::touch_face);
}());
static_assert(same(Contacts::none, ContactDetail::none) &&
              same(Contacts::kinds, ContactDetail::kinds) &&
              same(Contacts::segments, ContactDetail::segments));

}  // namespace

void load_input(const Input& input, bool self, const std::vector<bool>& self_objects,
                TakenInput& taken, FrameChange* change, bool asked) {
  try {
    bool same = false;
    taken.loss = 0;
    if (input.poses.empty()) {
      same = copy(input, self, self_objects, taken, taken.scene.vertices, change, asked);
      taken.unmoved = {};
      taken.object_of = {};
      taken.poses = {};
      taken.stale = false;
      taken.rigid.reset();
    } else {
      same = copy_posed(input, self, self_objects, taken, change, asked);
    }
    if (change) change->same = same;
  } catch (...) {
    taken = {};  // `taken` may hold unchecked input
    throw;
  }
}

std::optional<BlockDecision> load_poses(const Input& input, const PosesQuestion& question,
                                        TakenInput& taken) {
  Scene& scene = taken.scene;
  if (!are_alone(input) || taken.poses.size() != input.poses.size() || has_self(scene))
    return std::nullopt;
  std::vector<RigidMotion> motions(input.poses.size());
  std::ranges::transform(input.poses, motions.begin(), motion_of);
  for (const auto& [r, t] : motions) {
    if (!all_finite(r) || !all_finite(t) || !is_invertible(r)) return std::nullopt;
  }
  std::uint64_t of_moved = 0;
  for (std::size_t o = 0; o < motions.size(); ++o)
    of_moved += input.poses[o] != taken.poses[o] ? scene.objects[o].triangle_count : 0;
  const bool keeps_frames = question.keeps_frames && !taken.stale;
  if (keeps_frames && of_moved == 0) return std::nullopt;
  if (taken.skips > 0) {
    --taken.skips;
    return std::nullopt;
  }
  taken.skips = taken.next_skips;  // set to 0 below if the call succeeds
  taken.next_skips = std::min(2 * taken.next_skips, kMostSkips);
  try {
    if (!taken.rigid) {
      scene.vertices.swap(taken.unmoved);
      taken.rigid = make_rigid_blocks(scene, question.threads);
      scene.vertices.swap(taken.unmoved);
    }
    auto decision = decide_by_motions(scene, motions, question.clearance, question.ignored,
                                      question.threads, *taken.rigid);
    if (!decision) return std::nullopt;
    if (!pays(decision->blocks.triangles, of_moved, keeps_frames, taken)) return std::nullopt;
    taken.stale = true;
    move_vertices(taken.unmoved, motions, *taken.rigid, decision->blocks.pairs, question.threads,
                  scene);
    if (overlaps_by_sample(scene, decision->blocks, question.clearance) > kOverlapsPerTriangle)
      return std::nullopt;
    taken.poses.assign(input.poses.begin(), input.poses.end());
    taken.skips = 0;
    taken.next_skips = 1;
    return decision;
  } catch (...) {
    taken = {};
    throw;
  }
}

void require_threads(unsigned threads) {
  if (threads > 1024)
    throw Error("threads", "are more than 1024", "give a number up to 1024, or 0");
}

Contact to_public(const ContactShape& shape) {
  const auto point = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
  return {.kind = static_cast<Contact::Kind>(shape.kind),
          .dimension = shape.dimension,
          .ends = {point(shape.ends[0]), point(shape.ends[1])}};
}

std::vector<Contact> to_public(const std::vector<ContactShape>& shapes) {
  std::vector<Contact> out;
  out.reserve(shapes.size());
  for (const ContactShape& shape : shapes) out.push_back(to_public(shape));
  return out;
}

std::vector<ObjectPair> ignored_of(const std::vector<std::array<std::uint32_t, 2>>& ignore,
                                   std::size_t objects) {
  std::vector<ObjectPair> out;
  for (const auto& [a, b] : ignore) {
    const std::string text = "names objects " + std::to_string(a) + " and " + std::to_string(b);
    if (std::max(a, b) >= objects) {
      throw Error("ignore", text + " of " + std::to_string(objects) + ", numbered from 0",
                  "give two objects of the input in each pair");
    }
    if (a == b) {
      throw Error("ignore", text + ", which are one",
                  "give two different objects; self_objects says which are tested against "
                  "themselves");
    }
    out.push_back({a, b});
  }
  return in_order(std::move(out));
}

const char* to_string(Contact::Kind kind) {
  // name_of() returns a view of a string literal, which ends with a 0.
  return name_of(kContactKinds.at(static_cast<std::size_t>(kind))).data();
}

}  // namespace farcull
