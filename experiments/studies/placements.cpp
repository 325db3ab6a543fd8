// Places patches of triangles. A patch grows from a random triangle over shared vertices. Each
// placement is two patches in one cell. Cell (i, j) of n x n cells is at (i, j, i + j modulo n), so
// no two cells overlap in a view along x, y or z.
#include "experiments/studies/run_point.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "core/native/canvas.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "offsets/offsets.h"

namespace farcull {
namespace {

using shapes::Corners;
using shapes::Random;

/// A native canvas that first rounds the corners of proxies to multiples of 2^-bits px. A GL device
/// may snap corners in this way (assumption A2, docs/reliability.md).
class SnappingCanvas final : public Canvas {
 public:
  SnappingCanvas(const Fattener& fattener, int bits, unsigned threads)
      : native_(fattener.mode, fattener.solid, {.threads = threads}),
        limits_(native_.limits()),
        bits_(bits) {
    if (bits_ == 0) return;
    limits_.subpixel_bits = bits_;
    limits_.exact_samples = false;
  }

  const RasterLimits& limits() const override { return limits_; }
  void begin(const Window& window, const Drawables& drawables) override {
    snapped_ = drawables;
    if (bits_ > 0) {
      const float grid = std::ldexp(1.0f, bits_);
      for (Proxy& proxy : snapped_.proxies) {
        for (float& x : proxy.corners) x = std::rint(x * grid) / grid;
      }
    }
    native_.begin(window, snapped_);
  }
  std::vector<std::uint8_t> run(const Pass& pass) override { return native_.run(pass); }

 private:
  NativeCanvas native_;
  RasterLimits limits_;
  int bits_;
  Drawables snapped_;
};

template <class Patch, class Use>
void each_point(Patch& patch, const Use& use) {
  for (auto& corners : patch) {
    for (auto& p : corners) use(p);
  }
}

Vec3 mean(const Corners& c) { return (c[0] + c[1] + c[2]) / 3; }

double longest(const Corners& c) {
  return std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
}

// Centres a patch at the origin. Scales the patch so that the longest sides of its triangles have
// the mean length `side`.
void fit(std::vector<Corners>& patch, double side) {
  Vec3 middle = Vec3::Zero();
  double sum = 0;
  for (const Corners& c : patch) {
    middle += mean(c) / static_cast<double>(patch.size());
    sum += longest(c) / static_cast<double>(patch.size());
  }
  const double scale = sum > 0 ? side / sum : 0;
  each_point(patch, [&](Vec3& p) { p = (p - middle) * scale; });
}

// Rotates a patch by a random unit quaternion. Uses no sines, so the result is the same on every
// machine.
void turn(std::vector<Corners>& patch, Random& random) {
  Eigen::Quaterniond q;
  do {
    q = Eigen::Quaterniond(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1),
                           random.between(-1, 1));
  } while (!(q.squaredNorm() <= 1 && q.squaredNorm() > 0.01));
  q.normalize();
  const Eigen::Matrix3d by = q.toRotationMatrix();
  each_point(patch, [&](Vec3& p) { p = by * p; });
}

// Cuts a patch of `count` triangles from an object: a random triangle and its nearest neighbours
// over shared vertices. If the neighbours are too few, as in a soup of triangles, adds random
// triangles beside the first triangle. Scales the patch to `side` and turns it at random. around:
// for each vertex, the object's triangles at this vertex.
std::vector<Corners> cut(const Scene& scene, const Object& object,
                         const std::vector<std::vector<std::uint32_t>>& around, Random& random,
                         std::uint32_t count, double side) {
  const auto corners_of = [&](std::uint32_t t) { return scene.corners(object.first_triangle + t); };
  std::vector<std::uint32_t> taken = {random.below(object.triangle_count)};
  for (std::size_t i = 0; i < taken.size() && taken.size() < count; ++i) {
    for (const std::uint32_t v : scene.triangles[object.first_triangle + taken[i]]) {
      for (const std::uint32_t t : around[v]) {
        if (taken.size() < count && std::ranges::count(taken, t) == 0) taken.push_back(t);
      }
    }
  }
  std::vector<Corners> out;
  for (const std::uint32_t t : taken) out.push_back(corners_of(t));
  const Vec3 middle = mean(out[0]);
  const double reach = longest(out[0]);
  while (out.size() < count) {
    Corners more = corners_of(random.below(object.triangle_count));
    const double size = longest(more);
    if (!(size > 0)) continue;
    // Scales the triangle to the size of the first triangle, and moves it near the first triangle.
    const Vec3 from = mean(more), to = middle + reach * random.in_ball();
    for (Vec3& c : more) c = to + (c - from) * (reach / size);
    out.push_back(more);
  }
  fit(out, side);
  turn(out, random);
  return out;
}

Vec3 inner(const Corners& c, Random& random) {
  double a = random.unit(), b = random.unit();
  if (a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  return c[0] + a * (c[1] - c[0]) + b * (c[2] - c[0]);
}

void shift(std::vector<Corners>& patch, const Vec3& by) {
  each_point(patch, [&](Vec3& p) { p += by; });
}

// Moves the second patch, so that a random point of the second patch coincides with a random point
// of the first patch. Returns the common point.
Vec3 cross(const std::vector<Corners>& one, std::vector<Corners>& other, Random& random) {
  const Vec3 to = inner(one[random.below(one.size())], random);
  shift(other, to - inner(other[random.below(other.size())], random));
  return to;
}

// Turns a triangle about an axis, so that the longest edge of its image gets a random direction
// near a diagonal of the pixels. cosine: the least cosine of the angle between edge and diagonal.
// The triangle's rectangle is drawn along this edge (offsets/fit.inl). Uses no sines, like turn().
void turn_to_diagonal(Corners& corners, int axis, double cosine, Random& random) {
  const int right = (axis + 1) % 3, up = (axis + 2) % 3;
  double x = 0, y = 0, length = 0;
  do {
    x = random.between(-1, 1);
    y = random.between(-1, 1);
    length = std::sqrt(x * x + y * y);
  } while (!(length <= 1 && length > 0.1 &&
             std::abs(x) + std::abs(y) >= std::sqrt(2.0) * cosine * length));
  double longest = 0, c = 1, s = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = corners[(i + 1) % 3] - corners[i];
    const double image = std::sqrt(edge[right] * edge[right] + edge[up] * edge[up]);
    if (!(image > longest)) continue;
    longest = image;
    c = (edge[right] * x + edge[up] * y) / (image * length);
    s = (edge[right] * y - edge[up] * x) / (image * length);
  }
  for (Vec3& p : corners) {
    const double from = p[right];
    p[right] = c * from - s * p[up];
    p[up] = s * from + c * p[up];
  }
}

// Reflects and moves the second patch, so that its corner farthest from its middle pokes through a
// triangle of the first patch. The corner's depth is a random fraction, 2^-20 to 1, of the smaller
// of 1 px and that triangle's longest side.
void graze(const std::vector<Corners>& one, std::vector<Corners>& other, Random& random) {
  const Corners& face = one[random.below(one.size())];
  Vec3 normal = (face[1] - face[0]).cross(face[2] - face[0]);
  Vec3 tip = Vec3::Zero();
  each_point(other, [&](const Vec3& p) {
    if (p.squaredNorm() > tip.squaredNorm()) tip = p;
  });
  if (!(normal.norm() > 0) || !(tip.norm() > 0)) {
    cross(one, other, random);
    return;
  }
  normal /= normal.norm();
  // The reflection that maps the direction of the tip to -normal.
  const Vec3 across = tip / tip.norm() + normal;
  const double square = across.squaredNorm();
  const auto reflected = [&](const Vec3& p) -> Vec3 {
    return square > 0 ? Vec3(p - 2 * across.dot(p) / square * across) : p;
  };
  each_point(other, [&](Vec3& p) { p = reflected(p); });
  const double depth = std::min(1.0, longest(face)) * random.over_octaves(20);
  shift(other, inner(face, random) - reflected(tip) - depth * normal);
}

double reach_of(const std::vector<Corners>& patch) {
  double out = 0;
  each_point(patch, [&](const Vec3& p) { out = std::max(out, p.lpNorm<Eigen::Infinity>()); });
  return out;
}

}  // namespace

PatchSource::PatchSource(Scene from) : from_(std::move(from)) {
  for (std::size_t o = 0; o < 2; ++o) {
    const Object& object = from_.objects.at(o);
    around_[o].resize(from_.vertices.size());
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      for (const std::uint32_t v : from_.triangles[object.first_triangle + t])
        around_[o][v].push_back(t);
    }
  }
}

// Derives the limits of CornerStratum, in pixels. Corners are snapped to multiples of g.
// 1. A triangle is drawn as a rectangle. Let n be the unit normal of an edge of the rectangle, at
//    the angle t from a diagonal of the pixels. Snapping moves the edge inward by at most
//    g/2 (|n.x| + |n.y|) = g/sqrt(2) cos(t).
// 2. Let q be the contact relative to the nearest corner of the pixels. The rectangle reaches at
//    least sqrt(1/2) beyond the contact. So the rectangle loses (no longer covers) the pixel
//    centre on this diagonal only if n.q < sqrt(1/2) ((1 + g) cos(t) - 1).
// 3. A pair is missed only if each of the four centres around the corner is lost by one of the two
//    triangles. Suppose that each triangle loses two opposite centres. Then step 2 holds for n and
//    -n, so cos(t) > 1 / (1 + g), and q is inside a strip for each triangle. If q is in both
//    strips, then |q.x| + |q.y| < c. Here c (corner_px) is the largest value with
//    c (cos(t) - sin(t)) = (1 + g) cos(t) - 1 for some t.
// 4. If the triangles lose the centres in another way, the sum of their two bounds in step 2 is
//    positive. Then each angle t is at most sqrt(2) times as large as in step 3. From 8 bits on,
//    c is at most 1.4 times as large. Such misses are in the stratum of twice the width. The
//    rates of the two strata show how many such misses there are.
// 5. One triangle alone does not lose all four centres, to first order in g. Even after snapping,
//    two corners of its rectangle are at least 2 px apart in x, and the other two corners in y. If
//    the triangle lost all four centres, the sum of the four conditions of step 2 would make one of
//    these distances less than 2 px.
CornerStratum corner_stratum(int widening, int subpixel_bits, int resolution) {
  // Without snapping, corners are only rounded to floats. At the edge of the window, floats are
  // multiples of 2^-25 of the window's side.
  const double grid =
      subpixel_bits > 0 ? std::ldexp(1.0, -subpixel_bits) : std::ldexp(resolution, -25);
  const double reach = 0.5 * (1 + grid);
  CornerStratum out{widening * (reach - std::sqrt(0.5 - reach * reach)), 1 / (1 + grid)};
  for (int times = 1; times < widening; times *= 2)  // the cosine of twice the angle
    out.corner_cosine = std::max(std::sqrt(0.5), 2 * out.corner_cosine * out.corner_cosine - 1);
  return out;
}

PlacedPatches PatchSource::place(const PlacementPoint& point, const CornerStratum& stratum,
                                 std::uint64_t most, std::uint64_t seed) const {
  Random random(seed);
  // A cell has room for two touching patches, a ball and a margin of pixels.
  const double cell = std::ceil(10 * point.side + 6), room = 0.5 * cell - 2,
               half = 0.5 * point.resolution;
  const auto n = static_cast<std::uint64_t>(std::floor(point.resolution / cell));
  const std::uint32_t count = point.pairs ? 1 : kPatchTriangles;
  if (n < 1) throw std::logic_error("place_patches: the window is smaller than a placement");
  PlacedPatches out;
  std::vector<Corners> one, other;
  for (std::uint64_t k = 0; k < n * n && out.placements < most; ++k) {
    const auto i = static_cast<double>(k / n), j = static_cast<double>(k % n),
               diagonal = static_cast<double>((k / n + k % n) % n);
    std::vector<Corners> a, b;
    do {  // repeats while a patch leaves the cell and could meet patches of other cells
      a = cut(from_, from_.objects[0], around_[0], random, count, point.side);
      b = cut(from_, from_.objects[1], around_[1], random, count, point.side);
      if (point.grazing) {
        graze(a, b, random);
        continue;
      }
      const Vec3 contact = cross(a, b, random);
      if (!point.pairs) continue;
      for (auto* patch : {&a, &b}) shift(*patch, -contact);
    } while (std::max(reach_of(a), reach_of(b)) > room);
    Vec3 at = random.in_cube(0.5);
    if (point.widening > 0) {
      const auto axis = static_cast<int>(random.below(3));
      const double s = random.between(-0.5, 0.5), t = random.between(-0.5, 0.5);
      at[(axis + 1) % 3] = stratum.corner_px * (s + t);
      at[(axis + 2) % 3] = stratum.corner_px * (s - t);
      for (auto* patch : {&a, &b})
        turn_to_diagonal(patch->front(), axis, stratum.corner_cosine, random);
    }
    at += cell * Vec3(i, j, diagonal);
    if (point.pairs) at.array() += std::ceil(0.5 * cell) - half;
    shift(a, at);
    shift(b, at);
    one.insert(one.end(), a.begin(), a.end());
    other.insert(other.end(), b.begin(), b.end());
    ++out.placements;
  }
  if (point.pairs) {
    // Gives both objects a point at each end of the window, so that the window ranges from -half to
    // half. Then corners of pixels are at whole numbers.
    for (const double end : {-half, half}) {
      for (auto* list : {&one, &other})
        list->push_back({Vec3::Constant(end), Vec3::Constant(end), Vec3::Constant(end)});
    }
  }
  SceneBuilder scene("placements", "placements");
  scene.add(shapes::soup(one), "first");
  scene.add(shapes::soup(other), "second");
  out.scene = scene.finish();
  return out;
}

double intersection_length(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  std::vector<Vec3> points;
  const auto pierce = [&points](const std::array<Vec3, 3>& face, const Vec3& p, const Vec3& q) {
    const Vec3 normal = (face[1] - face[0]).cross(face[2] - face[0]);
    const double from = normal.dot(p - face[0]), to = normal.dot(q - face[0]);
    if (from * to > 0 || from == to) return;
    const Vec3 x = p + from / (from - to) * (q - p);
    for (int i = 0; i < 3; ++i) {
      const Vec3 side = face[(i + 1) % 3] - face[i];
      if (normal.dot(side.cross(x - face[i])) < 0) return;
    }
    points.push_back(x);
  };
  for (int i = 0; i < 3; ++i) {
    pierce(a, b[i], b[(i + 1) % 3]);
    pierce(b, a[i], a[(i + 1) % 3]);
  }
  double length = 0;
  for (const Vec3& p : points) {
    for (const Vec3& q : points) length = std::max(length, (p - q).norm());
  }
  return length;
}

std::uint64_t placement_seed(const PlacementPoint& point, std::uint64_t window) {
  // PlacementPoint::side is a multiple of 2^-10 px.
  const auto side = static_cast<std::uint64_t>(std::llrint(std::ldexp(point.side, 10)));
  std::vector<std::uint32_t> words;
  for (const std::uint64_t number :
       {point.seed, window, side, static_cast<std::uint64_t>(point.resolution),
        static_cast<std::uint64_t>(point.grazing + 2 * point.pairs + 4 * point.widening)}) {
    words.push_back(static_cast<std::uint32_t>(number));
    words.push_back(static_cast<std::uint32_t>(number >> 32));
  }
  std::seed_seq sequence(words.begin(), words.end());  // the standard specifies its output
  std::array<std::uint32_t, 2> out{};
  sequence.generate(out.begin(), out.end());
  return (std::uint64_t{out[0]} << 32) | out[1];
}

PointResult measure_placements(const PlacementPoint& point, MeasurementContext& lab) {
  const PatchSource source(make_builtin_scene(point.from));
  const RunOptions options{.method = Method::far,
                           .resolution = point.resolution,
                           .radius = point.radius,
                           .depth = DepthMode::fragment,
                           .verify = false,
                           .no_shortcuts = true};
  PlacementCounts counts{.promises = guaranteed(options)};
  PointResult out{.device = "native"};
  int bits = point.subpixel_bits;
  Canvas* device_canvas = nullptr;  // null: each window gets a SnappingCanvas
  if (point.pairs && bits == 0) {
    const bool native = lab.session().canvas_device().native;
    device_canvas = &lab.session().canvas(
        obb_fattener(), {.depth_format = DepthFormat::float32, .query = QueryMode::flags});
    if (!native) {
      bits = device_canvas->limits().subpixel_bits;
      out.device = lab.session().context().info().renderer;
    }
  }
  const CornerStratum stratum = corner_stratum(point.widening, bits, point.resolution);
  if (point.widening > 0) counts.stratum = stratum;
  for (std::uint64_t window = 0; counts.placements < point.placements; ++window) {
    if (lab.progress()) {
      lab.progress()(fmt::format("{} of {} placements", counts.placements, point.placements));
    }
    const PlacedPatches placed = source.place(point, stratum, point.placements - counts.placements,
                                              placement_seed(point, window));
    const Scene& scene = lab.scene(fmt::format("{} {} px, seed {}, window {}", key_of(point).scene,
                                               point.resolution, point.seed, window),
                                   [&] { return placed.scene; });
    const Plan planned = plan(scene, options, lab.session().threads());
    const auto& work = std::get<DrawPlan>(planned.work);
    CullSettings settings = work.settings;
    std::vector<std::uint8_t> kept(scene.triangles.size(), 0);
    double pixel = 1;  // size of a pixel, in units of the scene
    if (!work.fatteners.empty()) {
      settings.fattener = work.fatteners.front();
      SnappingCanvas canvas(settings.fattener, point.subpixel_bits, lab.session().threads());
      const CullResult result =
          cull(scene, work.regions, settings, device_canvas ? *device_canvas : canvas);
      for (const std::uint32_t t : result.live) kept[t] = 1;
      for (const ViewReport& view : result.views) {
        if (view.drawn) pixel = std::min(pixel, view.pixel_size);
        counts.radius_px = std::max(counts.radius_px, view.radius_px);
        counts.budget_px = std::max(counts.budget_px, view.budget.radius());
      }
    }
    counts.placements += placed.placements;
    std::vector<std::uint8_t> collides(placed.placements), misses(placed.placements);
    for (const TrianglePair& pair : lab.truth().pairs) {
      const std::uint64_t at = pair.a / (point.pairs ? 1 : kPatchTriangles);
      if (at >= placed.placements) continue;  // a pair of the points at the ends of the window
      collides[at] = 1;
      ++counts.colliding;
      if (kept[pair.a] && kept[pair.b]) continue;
      misses[at] = 1;
      ++counts.missed;
      counts.largest_miss_px =
          std::max(counts.largest_miss_px,
                   intersection_length(scene.corners(pair.a), scene.corners(pair.b)) / pixel);
    }
    counts.colliding_placements += std::ranges::count(collides, 1);
    counts.missed_placements += std::ranges::count(misses, 1);
  }
  out.counts = counts;
  return out;
}

}  // namespace farcull
