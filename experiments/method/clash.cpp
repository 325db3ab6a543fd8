// Groups the colliding pairs of triangles by their objects, which gives the pairs of objects that
// meet. Then compares boxes to find other pairs of objects that may be near or contained.
#include "experiments/method/clash.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <tuple>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/boxes/join.h"
#include "experiments/method/distances.h"
#include "verify/inside.h"
#include "verify/overlap.h"

namespace farcull {
namespace {

/// Caches the box, surface, parts and solid of each object; computes all but the box at first use.
class Objects {
 public:
  explicit Objects(const Scene& scene)
      : scene_(scene), facts_(new Facts[scene.objects.size()]), boxes_(scene.objects.size()) {
    for_each_shared(boxes_.size(), 0, [&](std::size_t o) {
      boxes_[o] = Box::empty();
      for (std::uint32_t k = 0; k < scene.objects[o].triangle_count; ++k)
        boxes_[o].add(triangle_box(scene.objects[o].first_triangle + k));
    });
  }

  const std::vector<Box>& boxes() const { return boxes_; }
  Surface surface(std::uint32_t object) const {
    Facts& facts = facts_[object];
    std::call_once(facts.surface_found,
                   [&] { facts.surface = doubted_surface_of(scene_, object); });
    return facts.surface;
  }
  bool closed(std::uint32_t object) const { return surface(object) != Surface::open; }
  /// Precondition: the object is closed.
  const ClosedObject& solid(std::uint32_t object) const {
    Facts& facts = facts_[object];
    std::call_once(facts.solid_made, [&] {
      facts.solid = std::make_unique<ClosedObject>(scene_, object, surface(object), parts(object));
    });
    return *facts.solid;
  }
  const std::vector<Vec3>& parts(std::uint32_t object) const {
    Facts& facts = facts_[object];
    std::call_once(facts.parts_found,
                   [&] { facts.parts = point_of_each_part(scene_, scene_.objects[object]); });
    return facts.parts;
  }

  /// Returns `contained` if a connected part of `inner` is inside `outer`, `clear` if no part is
  /// inside, and `unknown` if this is undecided, for example because `outer` is not closed. Unless
  /// the result is `clear`, sets `point` to a corner of that part. Precondition: the surfaces do
  /// not meet, so one point decides for a whole part (experiments/method/distances.cpp).
  ClashVerdict containment(std::uint32_t outer, std::uint32_t inner, Vec3& point) const {
    const Object& object = scene_.objects[inner];
    bool any = false;
    for (std::uint32_t k = 0; k < object.triangle_count && !any; ++k)
      any = lies_within(triangle_box(object.first_triangle + k), boxes_[outer]);
    if (!any) return ClashVerdict::clear;
    ClashVerdict out = ClashVerdict::clear;
    for (const Vec3& p : parts(inner)) {
      if (!lies_within({p, p}, boxes_[outer])) continue;
      const Overlap in =
          closed(outer) ? overlap_at(scene_, outer, p, surface(outer)) : Overlap::unknown;
      if (in == Overlap::no) continue;
      point = p;
      if (in == Overlap::yes) return ClashVerdict::contained;
      out = ClashVerdict::unknown;
    }
    return out;
  }

  Box triangle_box(std::uint32_t triangle) const {
    const auto [p, q, r] = scene_.corners(triangle);
    return {p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r)};
  }

 private:
  struct Facts {
    std::once_flag surface_found, parts_found, solid_made;
    Surface surface = Surface::open;
    std::vector<Vec3> parts;
    std::unique_ptr<ClosedObject> solid;
  };

  const Scene& scene_;
  std::unique_ptr<Facts[]> facts_;
  std::vector<Box> boxes_;
};

/// The pairs of triangles that meet, sorted by objects, and one row for each pair of objects.
struct Meetings {
  std::vector<TrianglePair> pairs;
  std::vector<ClashRow> rows;
  std::vector<std::size_t> first;  // each row's first index in `pairs`; last: pairs.size()
};

Meetings meetings_of(const Scene& scene, std::vector<TrianglePair> pairs) {
  const std::vector<std::uint32_t> owner = owners(scene);
  const auto objects = [&](const TrianglePair& pair) {
    return ObjectPair{owner[pair.a], owner[pair.b]};
  };
  std::ranges::sort(pairs, {}, [&](const TrianglePair& p) { return std::tuple(objects(p), p); });
  Meetings out{.pairs = std::move(pairs), .rows = {}, .first = {}};
  for (std::size_t k = 0; k < out.pairs.size(); ++k) {
    if (!out.rows.empty() && out.rows.back().objects == objects(out.pairs[k])) continue;
    out.rows.push_back({.objects = objects(out.pairs[k])});
    out.first.push_back(k);
  }
  out.first.push_back(out.pairs.size());
  return out;
}

/// Sets the fields of a row that describe its contacts.
void describe(const Scene& scene, const Objects& objects, std::span<const TrianglePair> pairs,
              std::span<const ContactShape> contacts, ClashRow& row) {
  row.pairs = pairs.size();
  std::vector<std::array<std::array<double, 3>, 2>> ends;
  std::size_t best = 0;  // index of the pair for the witness: the first crossing pair, else 0
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const ContactShape& contact = contacts[k];
    ++row.kinds[static_cast<std::size_t>(contact.kind)];
    if (contact.kind == ContactKind::crossing && contacts[best].kind != ContactKind::crossing)
      best = k;
    if (contact.dimension == 0 || contact.dimension == 1) {
      for (const Vec3& p : contact.ends) row.box.add(p);
    } else {
      row.box.add(intersection(objects.triangle_box(pairs[k].a), objects.triangle_box(pairs[k].b)));
    }
    // Skips segments of coplanar triangles, which may be diagonals of flat faces. If such a
    // segment is on a real edge of a closed object, the edge's other triangle gives it as well.
    if (contact.dimension != 1 || contact.kind == ContactKind::coplanar) continue;
    const auto& [p, q] = contact.ends;
    ends.push_back({{{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z()}}});
  }
  const Closest common = closest_points(scene.corners(pairs[best].a), scene.corners(pairs[best].b));
  row.witness = {common.points[0], common.points[0]};
  const std::uint64_t crossing = row.kinds[static_cast<std::size_t>(ContactKind::crossing)];
  if (crossing > 0) row.verdict = ClashVerdict::clash;
  // Removes duplicates: a segment on an edge is found with each of the edge's two triangles.
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const auto& [p, q] : ends) {
    row.segments.push_back({Vec3(p[0], p[1], p[2]), Vec3(q[0], q[1], q[2])});
    row.curve += (row.segments.back()[1] - row.segments.back()[0]).stableNorm();
  }
}

/// Decides whether two objects overlap or only touch. Precondition: none of their triangles cross.
void decide_touch(const Scene& scene, const Objects& objects, std::span<const TrianglePair> pairs,
                  ClashRow& row) {
  const auto [a, b] = row.objects;
  if (plane_divides(scene, row.objects, pairs)) {
    row.verdict = ClashVerdict::touch;
    return;
  }
  const Overlap overlap =
      overlap_of_touching(scene, row.objects, pairs, objects.parts(a), objects.parts(b),
                          {objects.surface(a), objects.surface(b)});
  row.verdict = overlap == Overlap::no ? ClashVerdict::touch : ClashVerdict::clash;
  row.proved = overlap != Overlap::unknown;
}

/// Records likely faults of the input: copies of objects, and objects in different units.
void note_parts(const Objects& objects, const Scene& scene, ClashRecord& record) {
  constexpr std::size_t kMostCopies = 100;
  // kRounding: relative error of rounding to floats. kFar: ratio of sizes that is suspicious.
  constexpr double kRounding = 1e-6, kFar = 100;
  const std::vector<Box>& boxes = objects.boxes();
  std::vector<std::uint32_t> order;
  for (std::uint32_t o = 0; o < boxes.size(); ++o) {
    if (scene.objects[o].triangle_count > 0) order.push_back(o);
  }
  const auto size = [&](std::uint32_t o) { return (boxes[o].hi - boxes[o].lo).stableNorm(); };
  const auto count = [&](std::uint32_t o) { return scene.objects[o].triangle_count; };
  std::ranges::stable_sort(order, {},
                           [&](std::uint32_t o) { return std::pair(count(o), boxes[o].lo.x()); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t a = order[i];
    const double room =
        kRounding * std::max(boxes[a].lo.cwiseAbs().maxCoeff(), boxes[a].hi.cwiseAbs().maxCoeff());
    for (std::size_t k = i + 1; k < order.size() && record.copies.size() < kMostCopies; ++k) {
      const std::uint32_t b = order[k];
      if (count(a) != count(b) || boxes[b].lo.x() > boxes[a].lo.x() + room) break;
      if ((boxes[a].lo - boxes[b].lo).cwiseAbs().maxCoeff() <= room &&
          (boxes[a].hi - boxes[b].hi).cwiseAbs().maxCoeff() <= room)
        record.copies.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  if (order.empty()) return;
  const auto [least, most] = std::ranges::minmax(order, {}, size);
  if (size(most) >= kFar * size(least)) record.sizes = {least, most};
}

/// Returns directions in which a short move may separate two objects. These are the normals of the
/// largest faces that meet, and the sums and differences of two or three of these normals.
std::vector<Vec3> ways_apart(const Scene& scene, std::span<const TrianglePair> pairs) {
  constexpr std::size_t kMostFound = 64, kMost = 6;
  constexpr double kSame = 0.999;              // cosine above which directions are equal
  std::vector<std::pair<double, Vec3>> faces;  // area, normal
  for (const TrianglePair& pair : pairs) {
    for (const std::uint32_t triangle : {pair.a, pair.b}) {
      const auto [p, q, r] = scene.corners(triangle);
      const Vec3 across = (q - p).cross(r - p), normal = across.stableNormalized();
      if (!(std::abs(normal.norm() - 1) < 1e-9)) continue;
      const auto same = std::ranges::find_if(
          faces, [&](const auto& face) { return std::abs(face.second.dot(normal)) > kSame; });
      if (same != faces.end())
        same->first += across.stableNorm();
      else if (faces.size() < kMostFound)
        faces.emplace_back(across.stableNorm(), normal);
    }
  }
  std::ranges::stable_sort(faces, std::greater(), [](const auto& face) { return face.first; });
  faces.resize(std::min(faces.size(), kMost));
  std::array<std::vector<Vec3>, 3> sums;  // sums[k]: signed sums of k + 1 normals
  for (const auto& [area, normal] : faces) {
    for (const std::size_t k : {2u, 1u}) {
      for (const Vec3& sum : std::vector<Vec3>(sums[k - 1]))
        sums[k].push_back(sum + normal), sums[k].push_back(sum - normal);
    }
    sums[0].push_back(normal);
  }
  std::vector<Vec3> out;
  for (const auto& some : sums) {
    for (const Vec3& sum : some) {
      if (sum.norm() > 1e-3) out.push_back(sum.normalized());
    }
  }
  return out;
}

/// Bounds how deep two objects overlap, if options.depth or options.tolerance is set. If the upper
/// bound is at most the tolerance, the verdict becomes `touch`. If the tolerance is between the
/// bounds and no deep point is found, sets ClashRow::shallow. pairs: the triangles that meet; empty
/// if one object contains the other. Precondition: each object is closed.
void bound_depth(const Scene& scene, const Objects& objects, std::span<const TrianglePair> pairs,
                 const ClashOptions& options, ClashRow& row) {
  const ClosedObject &a = objects.solid(row.objects.a), &b = objects.solid(row.objects.b);
  constexpr std::size_t kStarts = 16;
  std::vector<Vec3> starts = {row.witness[0]};
  if (!row.box.is_empty()) starts.push_back(0.5 * row.box.lo + 0.5 * row.box.hi);
  const std::size_t stride = row.segments.size() / kStarts + 1;
  for (std::size_t k = 0; k < row.segments.size(); k += stride)
    starts.push_back(0.5 * row.segments[k][0] + 0.5 * row.segments[k][1]);
  if (options.depth && row.proved) row.depth = penetration(a, b, starts, options.threads);
  const double tolerance = options.tolerance;
  if (tolerance == 0) return;
  if (!row.depth || row.depth->hi > tolerance) {
    const std::vector<Vec3> ways = ways_apart(scene, pairs);
    Penetration found =
        penetration(a, b, starts, options.threads, DepthLimit{.most = tolerance, .ways = ways});
    if (found.hi > tolerance) {
      // A point is deep if it is inside an object, farther than the tolerance from the object's
      // surface. Such a point stays inside if it moves by the tolerance. The computed distance is
      // rounded, so a deep point proves nothing.
      const auto is_deep = [&](const Vec3& p) {
        return std::ranges::any_of(std::array{&a, &b}, [&](const ClosedObject* solid) {
          return solid->has(p) && (solid->nearest(p) - p).norm() > tolerance;
        });
      };
      const auto has_deep = [&](std::uint32_t triangle) {
        const auto [p, q, r] = scene.corners(triangle);
        return std::ranges::any_of(std::array<Vec3, 4>{p, q, r, (p + q + r) / 3}, is_deep);
      };
      constexpr std::size_t kMost = 1000;  // at most this many pairs are examined
      const auto some = pairs.first(std::min(pairs.size(), kMost));
      if (found.lo > tolerance || is_deep(row.witness[0]) ||
          std::ranges::any_of(some, [&](const auto& p) { return has_deep(p.a) || has_deep(p.b); }))
        return;
      // A search with a limit may give no lower bound, so this search has no limit.
      found = row.depth ? *row.depth : penetration(a, b, starts, options.threads);
      row.shallow = found.lo <= tolerance && found.hi > tolerance;
      if (row.shallow && std::isfinite(found.hi)) row.depth = found;
      if (found.hi > tolerance) return;
    }
    row.depth = {.lo = row.depth ? row.depth->lo : found.lo,
                 .hi = found.hi,
                 .translation = found.translation};
  }
  row.verdict = ClashVerdict::touch;
}

/// Adds a stage with the time of the watch, and restarts the watch.
void add_stage(ClashRecord& record, StageKind kind, Stopwatch& watch, std::uint64_t in,
               std::uint64_t out) {
  record.trace.push_back(
      {.kind = kind, .ran = true, .ms = watch.ms(), .in = in, .out = out, .unit = Unit::pairs});
  watch = Stopwatch();
}

bool is_asked(const ClashOptions& options, const ObjectPair& pair) {
  return !options.only || std::ranges::binary_search(*options.only, pair);
}

/// Returns rows for objects that do not meet: near pairs, and pairs with possible containment.
std::vector<ClashRow> apart_rows(const Scene& scene, const Objects& objects,
                                 const ClashOptions& options, std::span<const ClashRow> meeting,
                                 const Progress& progress, ClashRecord& record) {
  Stopwatch watch;
  const double reach = std::max(options.clearance, options.tolerance);
  std::vector<Box> boxes = objects.boxes();
  for (Box& box : boxes) box = grow(box, half_of(reach));
  std::vector<std::uint32_t> every(boxes.size());
  std::iota(every.begin(), every.end(), 0u);
  std::vector<ObjectPair> pairs;
  for (const TrianglePair& pair : box_join(boxes, every, every, SIZE_MAX, options.threads)) {
    const ObjectPair one{pair.a, pair.b};
    if (!is_asked(options, one)) continue;
    const auto at = std::ranges::lower_bound(meeting, one, {}, &ClashRow::objects);
    if (at == meeting.end() || at->objects != one) pairs.push_back(one);
  }
  std::vector<ClashRow> rows(pairs.size());
  if (progress) progress(StageKind::inside);
  for_each_shared(pairs.size(), options.threads, [&](std::size_t k) {
    ClashRow& row = rows[k];
    row.objects = pairs[k];
    for (const auto& [outer, inner] :
         {std::pair(pairs[k].a, pairs[k].b), std::pair(pairs[k].b, pairs[k].a)}) {
      Vec3 point = Vec3::Zero();
      const ClashVerdict verdict = objects.containment(outer, inner, point);
      if (verdict >= row.verdict) continue;
      row.verdict = verdict;
      row.inner = inner;
      row.box = objects.boxes()[inner];
      row.witness = {point, point};
    }
  });
  add_stage(record, StageKind::inside, watch, rows.size(),
            rows.size() - static_cast<std::size_t>(
                              std::ranges::count(rows, ClashVerdict::clear, &ClashRow::verdict)));
  for (ClashRow& row : rows) row.exact = row.verdict;
  if (reach > 0) {
    std::uint64_t near = 0;
    for (Distance& d : nearest_triangles(scene, pairs, reach, options.threads, progress)) {
      ClashRow& row = *std::ranges::lower_bound(rows, d.objects, {}, &ClashRow::objects);
      ++near;
      row.squared = d.closest.squared;
      row.distance = d.closest.distance;
      if (row.verdict != ClashVerdict::clear) continue;
      if (options.clearance > 0 && d.closest.squared <= SquaredDistance::of(options.clearance))
        row.verdict = row.exact = ClashVerdict::near;
      if (options.tolerance > 0 && d.closest.squared <= SquaredDistance::of(options.tolerance))
        row.verdict = ClashVerdict::touch;
      row.witness = d.closest.points;
      for (const Vec3& p : d.closest.points) row.box.add(p);
    }
    add_stage(record, StageKind::near, watch, pairs.size(), near);
  }
  std::erase_if(rows, [](const ClashRow& row) { return row.verdict == ClashVerdict::clear; });
  return rows;
}

/// True if x comes before y. Rows that are not ignored come first. Rows are then sorted by verdict,
/// smaller distance, larger depth, longer curve, and lower numbers of the objects.
bool more_serious(const ClashRow& x, const ClashRow& y) {
  if (x.ignored != y.ignored) return y.ignored;
  if (x.verdict != y.verdict) return x.verdict < y.verdict;
  if (x.verdict == ClashVerdict::near && x.squared != y.squared) return *x.squared < *y.squared;
  const auto depth = [](const ClashRow& row) { return row.depth ? row.depth->hi : 0; };
  return std::tuple(-depth(x), -x.curve, x.objects) < std::tuple(-depth(y), -y.curve, y.objects);
}

}  // namespace

std::string to_string(ClashVerdict verdict) {
  constexpr std::array kNames = {"clash", "contained", "unknown", "touch", "near", "clear"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

double size_of(const Scene& scene, std::uint32_t object) {
  Box box = Box::empty();
  const Object& o = scene.objects[object];
  for (std::uint32_t t = o.first_triangle; t < o.first_triangle + o.triangle_count; ++t) {
    for (const Vec3& p : scene.corners(t)) box.add(p);
  }
  return box.is_empty() ? 0 : (box.hi - box.lo).stableNorm();
}

ClashRecord clashes(const Scene& scene, const ClashOptions& options, const Progress& progress) {
  if (!(options.clearance >= 0 && std::isfinite(options.clearance)))
    throw Error("clearance", "is no distance", "give a finite number of world units, 0 or more");
  if (!(options.tolerance >= 0 && std::isfinite(options.tolerance)))
    throw Error("tolerance", "is no distance", "give a finite number of world units, 0 or more");
  const std::uint64_t count = scene.objects.size();
  if (count < 2) throw Error("scene", "has fewer than two objects", "name two parts or more");
  const FloatingPointGuard guard;
  const Stopwatch watch;
  ClashRecord out;
  out.options = options;
  for (std::uint32_t o = 0; o < count; ++o) {
    if (scene.objects[o].triangle_count == 0) out.empty.push_back(o);
  }
  const std::uint64_t full = count - out.empty.size();
  const auto has_empty = [&](const ObjectPair& pair) {
    return scene.objects[pair.a].triangle_count == 0 || scene.objects[pair.b].triangle_count == 0;
  };
  const auto counted = [](const std::vector<ObjectPair>& pairs, const auto& which) {
    return static_cast<std::uint64_t>(std::ranges::count_if(pairs, which));
  };
  const auto asked = [&](const ObjectPair& pair) { return is_asked(options, pair); };
  const auto asked_empty = [&](const ObjectPair& p) { return asked(p) && has_empty(p); };
  out.ignored = counted(options.ignored, asked);
  out.asked = (options.only ? options.only->size() : count * (count - 1) / 2) - out.ignored;
  out.examined = (options.only ? options.only->size() - counted(*options.only, has_empty)
                               : full * (full - (full > 0)) / 2) -
                 (out.ignored - counted(options.ignored, asked_empty));
  const Objects objects(scene);
  note_parts(objects, scene, out);
  std::vector<TrianglePair> found;
  if (full >= 2) {
    Session session("cpu", options.threads);
    RunOptions run_options{.device = "cpu", .verify = false};
    run_options.neighbours = false;
    Record record = run(scene, run_options, session, progress, {.answer_only = true});
    out.trace = std::move(record.trace);
    found = std::move(record.collisions.pairs);
    const std::vector<std::uint32_t> owner = owners(scene);
    std::erase_if(found, [&](const TrianglePair& p) { return !asked({owner[p.a], owner[p.b]}); });
  }
  Stopwatch step;
  if (progress) progress(StageKind::contacts);
  Meetings meetings = meetings_of(scene, std::move(found));
  out.triangle_pairs = meetings.pairs.size();
  const unsigned threads =
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  const std::vector<ContactShape> contacts = contact_shapes(scene, meetings.pairs, threads);
  add_stage(out, StageKind::contacts, step, out.triangle_pairs, meetings.rows.size());
  std::vector<ClashRow> apart = apart_rows(scene, objects, options, meetings.rows, progress, out);
  step = Stopwatch();
  if (progress) progress(StageKind::touch);
  for_each_shared(meetings.rows.size(), options.threads, [&](std::size_t k) {
    const std::size_t from = meetings.first[k], size = meetings.first[k + 1] - from;
    const auto pairs = std::span(meetings.pairs).subspan(from, size);
    ClashRow& row = meetings.rows[k];
    describe(scene, objects, pairs, std::span(contacts).subspan(from, size), row);
    if (row.verdict != ClashVerdict::clash) decide_touch(scene, objects, pairs, row);
    if (row.verdict != ClashVerdict::clash) row.curve = 0, row.segments.clear();
    row.exact = row.verdict;
  });
  const auto touching = static_cast<std::uint64_t>(
      std::ranges::count(meetings.rows, ClashVerdict::touch, &ClashRow::verdict));
  add_stage(out, StageKind::touch, step, meetings.rows.size(), touching);
  out.rows = std::move(meetings.rows);
  const std::size_t meeting = out.rows.size();
  out.rows.insert(out.rows.end(), std::make_move_iterator(apart.begin()),
                  std::make_move_iterator(apart.end()));
  if (options.depth || options.tolerance > 0) {
    if (progress) progress(StageKind::depth);
    std::vector<std::size_t> deep;
    for (std::size_t k = 0; k < out.rows.size(); ++k) {
      ClashRow& row = out.rows[k];
      if (row.verdict != ClashVerdict::clash && row.verdict != ClashVerdict::contained) continue;
      for (const std::uint32_t o : {row.objects.b, row.objects.a}) {
        if (!objects.closed(o)) row.open = o;
      }
      if (!row.open) deep.push_back(k);
    }
    for_each_shared(deep.size(), options.threads, [&](std::size_t i) {
      const std::size_t k = deep[i], from = k < meeting ? meetings.first[k] : 0;
      const std::size_t size = k < meeting ? meetings.first[k + 1] - from : 0;
      bound_depth(scene, objects, std::span(meetings.pairs).subspan(from, size), options,
                  out.rows[k]);
    });
    add_stage(out, StageKind::depth, step, out.rows.size(), deep.size());
  }
  for (ClashRow& row : out.rows) {
    row.ignored = std::ranges::binary_search(options.ignored, row.objects);
    if (row.ignored) {
      out.ignored_meet += row.verdict != ClashVerdict::near;
    } else {
      out.within_tolerance += row.within_tolerance();
      ++out.verdicts[static_cast<std::size_t>(row.verdict)];
    }
  }
  std::erase_if(out.rows, [](const ClashRow& row) {
    return row.ignored && row.verdict == ClashVerdict::near;
  });
  const std::uint64_t listed =
      std::accumulate(out.verdicts.begin(), out.verdicts.end(), std::uint64_t{0});
  out.verdicts[static_cast<std::size_t>(ClashVerdict::clear)] = out.examined - listed;
  std::ranges::sort(out.rows, more_serious);
  out.ms = watch.ms();
  return out;
}

}  // namespace farcull
