// A scene as a view sees it; and the choice of directions and resolutions, by estimates of the work
// from a sample of triangles. The estimates' accuracy affects only the time.
#include "core/pairs/pairs.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <sstream>

#include "core/base/parallel.h"
#include "core/boxes/block.h"

namespace farcull {
namespace {

constexpr double kLargest = 0x1p20;         // px, of a coordinate that kernels take
constexpr double kSmallest = 0x1p-60;       // px, of one that is not zero
constexpr double kLeastWidening = 0x1p-40;  // px

// A float that is not below x.
float float_above(double x) {
  const float f = static_cast<float>(x);
  return f < x ? std::nextafter(f, HUGE_VALF) : f;
}
float float_below(double x) { return -float_above(-x); }

PixelVertex pixel_vertex(const Vec3& p) {
  const auto rounded = [](double x) { return static_cast<float>(std::abs(x) < kSmallest ? 0 : x); };
  return {rounded(p.x()), rounded(p.y()), rounded(p.z()), 0};
}

}  // namespace

std::optional<PairWindow> pair_window(const PairRegions& regions, const View& view, int resolution,
                                      double clearance) {
  std::vector<Box> present;
  for (const Box& box : regions.objects) {
    if (box.is_empty()) continue;
    present.push_back(box);
  }
  const std::optional<Window> window = fit_window(view, present, resolution);
  if (!window) return std::nullopt;
  PairWindow out{.window = *window, .widening = {}};
  // The clearance, and the double arithmetic of the map for a vertex at the limit of drawability.
  for (int axis = 0; axis < 3; ++axis) {
    // Scaled before it is squared: rows of huge scenes are below what a square can hold.
    const double ball = half_of(clearance) * window->map.row(axis).stableNorm();
    const double sum = (ball + kMaxDoubleError + kLeastWidening) * (1 + 0x1p-20);
    if (!(sum <= kLargest)) return std::nullopt;
    out.widening[axis] = float_above(sum);
  }
  return out;
}

void look(const Scene& scene, const PairRegions& regions, std::span<const std::uint32_t> triangles,
          const PairWindow& seen_in, unsigned threads, PairScene& out) {
  const Window* const window = &seen_in.window;
  const std::array<float, 3>& widening = seen_in.widening;
  out.window = *window;

  const Vec3 corner(0.5 * window->width, 0.5 * window->height, 0);
  out.limits.resize(scene.objects.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (regions.objects[o].is_empty()) {
      out.limits[o] = {{1, 1, 1, 0}, {-1, -1, -1, 0}};
      continue;
    }
    Box px = pixel_box(*window, regions.objects[o]);
    px.lo += corner;
    px.hi += corner;
    out.limits[o] = {{float_below(px.lo.x()), float_below(px.lo.y()), float_below(px.lo.z()), 0},
                     {float_above(px.hi.x()), float_above(px.hi.y()), float_above(px.hi.z()), 0}};
  }

  // If the boxes of the objects are within the bounds, so is each of their vertices.
  const Box whole = pixel_box(*window, regions.reach);
  const double largest = std::max(whole.lo.cwiseAbs().maxCoeff(), whole.hi.cwiseAbs().maxCoeff());
  const bool all_drawable = largest + corner.maxCoeff() <= kLargest &&
                            pixel_error(*window, regions.reach) <= kMaxDoubleError;
  const std::size_t n = scene.vertices.size();
  out.vertices.resize(n);
  const std::size_t chunks = chunks_for(n, 4096, threads);
  std::atomic<bool> some_undrawable = false;
  for_chunks(n, chunks, [&](std::size_t, std::size_t begin, std::size_t end) {
    if (all_drawable) {
      const Eigen::Matrix3d map = window->map;
      const Vec3 origin = window->origin;
      for (std::size_t v = begin; v < end; ++v) {
        out.vertices[v] = pixel_vertex(map * (scene.vertices[v] - origin) + corner);
      }
      return;
    }
    bool bad = false;
    for (std::size_t v = begin; v < end; ++v) {
      const PixelPoint point = to_pixel(*window, scene.vertices[v]);
      const Vec3 p = point.p + corner;
      const bool drawable = point.error <= kMaxDoubleError && p.cwiseAbs().maxCoeff() <= kLargest;
      bad |= !drawable;
      out.vertices[v] = drawable ? pixel_vertex(p) : PixelVertex{0, 0, 0, 1};
    }
    if (bad) some_undrawable = true;
  });

  out.undrawable.clear();
  out.active.assign(triangles.begin(), triangles.end());
  if (some_undrawable) {
    out.active.clear();
    for (const std::uint32_t t : triangles) {
      const auto& c = scene.triangles[t];
      const bool bad =
          out.vertices[c[0]].w != 0 || out.vertices[c[1]].w != 0 || out.vertices[c[2]].w != 0;
      (bad ? out.undrawable : out.active).push_back(t);
    }
  }
  out.owners = owners(scene);
  out.self.resize(scene.objects.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o) out.self[o] = scene.objects[o].self;
  out.task = {.vertices = out.vertices,
              .triangles = scene.triangles,
              .owners = out.owners,
              .self = out.self,
              .limits = out.limits,
              .active = out.active,
              .width = window->width,
              .height = window->height,
              .near_px = float_below(window->lo[2]),
              .far_px = float_above(window->hi[2]),
              .widening = {widening[0], widening[1], widening[2], 0}};
}

namespace {

constexpr std::size_t kSample = 1024;
constexpr int kLeastResolution = 32, kMostResolution = 4096;  // px

// Work in units of one pixel that a triangle meets: measured ratios, rounded.
constexpr double kPixelWork = 0.3;  // a pixel of the window, whether or not anything is there
// Comparing two intervals, for each test that evenly filled pixels would need: lists between
// objects are uneven, which makes more tests.
constexpr double kTestWork = 2.5, kTestWorkSelf = 0.25;
// Between different objects the slices leave at least this part of the pixels that triangles meet,
// and more if triangles are deep.
constexpr double kLeftBySlices = 0.15;
// If triangles are deeper than this part of the scene in some view, their images lie too unevenly
// for estimates: the sample itself is looked at, with this work for a test and for a pair.
constexpr double kDeep = 0.075;
constexpr std::size_t kTrial = 192;  // triangles of the sample
constexpr double kTrialFrom = 4096;  // triangles; fewer are looked at in no time
constexpr double kTrialTest = 0.25, kTrialPair = 8;
// Work of each pixel of a triangle that meets more than a few: its rows are cut one by one.
constexpr double kTightPixelWork = 4;
// A direction that is no axis loses the exact boxes of the axes, so it has to win clearly.
constexpr double kOblique = 1.25;

/// Numbers of a view direction for the estimates, for triangles of the world in units of `extent`.
struct Image {
  double area = 0;   // mean of the triangles' images
  double girth = 0;  // mean width + height of the images
  double depth = 0;  // mean of the triangles' depths, over that of the regions
  double width = 0;  // of the regions
  double height = 0;
  double side() const { return std::max(width, height); }
};

struct Sample {
  std::vector<std::uint32_t> owners;           // of the triangles
  std::vector<std::array<Vec3, 3>> triangles;  // relative to the regions' centre, scaled to size 1
  Vec3 size;                                   // of the regions, scaled
  double count = 0;                            // triangles that the sample stands for
  bool self = false;
};

Sample draw(const Scene& scene, const PairRegions& regions) {
  Sample sample;
  Box box = Box::empty();
  for (const Box& region : regions.objects) {
    if (!region.is_empty()) box.add(region);
  }
  const Vec3 centre = 0.5 * box.lo + 0.5 * box.hi;
  const double extent = std::max((0.5 * box.hi - 0.5 * box.lo).maxCoeff(), 0x1p-1000);
  sample.size = (0.5 * box.hi - 0.5 * box.lo) / extent;
  const std::size_t n = regions.triangles.size();
  const std::size_t count = std::min(n, kSample);
  std::size_t o = 0, inside = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t t = regions.triangles[n * k / count];
    while (t >= scene.objects[o].first_triangle + scene.objects[o].triangle_count) ++o;
    const Box own = grown_box(scene, t, 0);
    if (!overlap(own, regions.objects[o])) continue;
    ++inside;
    std::array<Vec3, 3> corners = scene.corners(t);
    for (Vec3& corner : corners) corner = (corner - centre) / extent;
    if (corners[0].allFinite() && corners[1].allFinite() && corners[2].allFinite()) {
      sample.triangles.push_back(corners);
      sample.owners.push_back(static_cast<std::uint32_t>(o));
    }
  }
  sample.count = static_cast<double>(n) * static_cast<double>(inside) / static_cast<double>(count);
  sample.self = regions.self > 0;
  return sample;
}

Image image_of(const Sample& sample, const View& view) {
  Image out;
  const Eigen::Vector3d size = view.rows.cwiseAbs() * sample.size;
  out.width = std::max(2 * size.x(), 0x1p-60);
  out.height = std::max(2 * size.y(), 0x1p-60);
  for (const auto& corners : sample.triangles) {
    const Vec3 a = view.rows * corners[0], b = view.rows * corners[1], c = view.rows * corners[2];
    const Vec3 u = b - a, v = c - a;
    out.depth += std::max({a.z(), b.z(), c.z()}) - std::min({a.z(), b.z(), c.z()});
    out.area += 0.5 * std::abs(u.x() * v.y() - u.y() * v.x());
    for (const int axis : {0, 1}) {
      out.girth += std::max({a[axis], b[axis], c[axis]}) - std::min({a[axis], b[axis], c[axis]});
    }
  }
  const double n = static_cast<double>(std::max<std::size_t>(sample.triangles.size(), 1));
  out.area /= n;
  out.girth /= n;
  out.depth /= n * std::max(2 * size.z(), 0x1p-60);
  return out;
}

/// The work of a resolution: of pixels that triangles meet (the area of an image grown by a pixel),
/// of the window's pixels, and of pairs in them.
double work(const Sample& sample, const Image& image, int resolution) {
  const double pixel = image.side() / resolution;
  const double met = sample.count * (image.area / (pixel * pixel) + image.girth / pixel + 1);
  const double pixels = (image.width / pixel + 1) * (image.height / pixel + 1);
  const double left = sample.self ? 1 : std::clamp(2 * image.depth, kLeftBySlices, 1.0);
  const double tests = 0.25 * left * met * left * met / pixels;
  return met + kPixelWork * pixels + (sample.self ? kTestWorkSelf : kTestWork) * tests;
}

int best_resolution(const Sample& sample, const Image& image, double& least) {
  int best = kLeastResolution;
  least = HUGE_VAL;
  for (int step = 0; step <= 14; ++step) {  // half octaves, even
    const int resolution = 2 * static_cast<int>(0.5 * kLeastResolution * std::pow(2.0, 0.5 * step));
    const double w = work(sample, image, resolution);
    if (w < least) {
      least = w;
      best = resolution;
    }
  }
  return std::min(best, kMostResolution);
}

/// A part of the sample as a scene of its own, with the objects that have a triangle in it.
Scene scene_of(const Sample& sample, const Scene& scene) {
  Scene out;
  const std::size_t count = std::min(sample.triangles.size(), kTrial);
  std::uint32_t last = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::size_t from = sample.triangles.size() * t / count;
    const std::uint32_t owner = sample.owners[from];
    if (t == 0 || owner != last) out.objects.push_back({"", t, 0, scene.objects[owner].self});
    last = owner;
    ++out.objects.back().triangle_count;
    out.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    out.vertices.insert(out.vertices.end(), sample.triangles[from].begin(),
                        sample.triangles[from].end());
  }
  return out;
}

/// The work of the pixels that triangles meet, without that of their pairs.
double met_work(const Sample& sample, const Image& image, int resolution) {
  const double pixel = image.side() / resolution;
  const double each = image.area / (pixel * pixel) + image.girth / pixel + 1;
  return sample.count * each * (each > kWholePixels ? kTightPixelWork : 1);
}

/// The work of the pairs, by looking at a part of the sample: it grows with the square of the
/// number of triangles.
double pair_work(const Sample& sample, const Scene& part, const PairRegions& regions,
                 PairBackend& backend, const View& view, int resolution) {
  if (regions.triangles.empty()) return HUGE_VAL;
  const std::optional<PairWindow> window = pair_window(regions, view, resolution, 0);
  if (!window) return HUGE_VAL;
  PairScene seen;
  look(part, regions, regions.triangles, *window, 1, seen);
  seen.task.neighbours = false;
  PairCounts counts;
  const std::size_t pairs = backend.raw_pairs(seen.task, counts).size();
  const double times = sample.count / static_cast<double>(part.triangles.size());
  return times * times *
         (kTrialTest * static_cast<double>(counts.tests) + kTrialPair * static_cast<double>(pairs));
}

View view_along(const Vec3& direction) {
  std::ostringstream text;
  text.precision(6);
  text << direction.x() << ':' << direction.y() << ':' << direction.z();
  return parse_view(text.str());
}

/// Principal directions of the edges, weighted with their length; the longest first.
std::vector<View> principal_views(const Sample& sample) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const auto& corners : sample.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = corners[(k + 1) % 3] - corners[k];
      const double length = edge.norm();
      if (length > 0) sum += edge * edge.transpose() / length;
    }
  }
  std::vector<View> views;
  if (!sum.allFinite() || sum.isZero(0)) return views;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
  for (int k = 2; k >= 0; --k) {
    const Vec3 direction = solver.eigenvectors().col(k);
    if (direction.allFinite() && direction.norm() > 0.5) views.push_back(view_along(direction));
  }
  return views;
}

}  // namespace

std::vector<PairChoice> choose_pair_views(const Scene& scene, const PairRegions& regions,
                                          int resolution) {
  const Sample sample = draw(scene, regions);
  struct Ranked {
    PairChoice choice;
    double work;
  };
  std::vector<Ranked> ranked;
  const auto rank = [&](const View& view, double penalty, const std::string& what) {
    const Image image = image_of(sample, view);
    double least = 0;
    const int best = best_resolution(sample, image, least);
    const int used = resolution > 0 ? resolution : best;
    ranked.push_back({{view, used, what}, penalty * work(sample, image, used)});
  };
  for (const char* axis : {"x", "y", "z"}) {
    rank(parse_view(axis), 1, "axis of least estimated work");
  }
  for (const View& view : principal_views(sample)) {
    rank(view, kOblique, "principal direction of the edges, of least estimated work");
  }
  const bool deep = std::any_of(ranked.begin(), ranked.end(), [&](const Ranked& r) {
    return image_of(sample, r.choice.view).depth > kDeep;
  });
  const auto by_work = [](const Ranked& a, const Ranked& b) { return a.work < b.work; };
  if (deep && sample.count >= kTrialFrom) {
    const Scene part = scene_of(sample, scene);
    const PairRegions places = pair_regions(part, 0, false, 1);
    const auto backend = cpu_pair_backend(1);
    // Views that meet few pixels first; one whose pixels cost more than the best is not tried.
    for (Ranked& r : ranked) {
      r.work = met_work(sample, image_of(sample, r.choice.view), r.choice.resolution);
    }
    std::stable_sort(ranked.begin(), ranked.end(), by_work);
    double best = HUGE_VAL;
    for (Ranked& r : ranked) {
      if (r.work > best) continue;
      r.choice.reason += ", tried on a sample";
      const Image image = image_of(sample, r.choice.view);
      const int first = r.choice.resolution;
      r.work = HUGE_VAL;
      for (const int used : {first, 2 * first, 4 * first}) {
        const double met = met_work(sample, image, used);
        if (used > kMostResolution || met > best || (resolution > 0 && used != first)) break;
        const double w = met + pair_work(sample, part, places, *backend, r.choice.view, used);
        if (w >= r.work) break;
        r.work = w;
        r.choice.resolution = used;
      }
      best = std::min(best, r.work);
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(), by_work);
  std::vector<PairChoice> out;
  for (Ranked& r : ranked) {
    r.choice.reason += resolution > 0 ? "; resolution given" : "; pixels by the triangles' sizes";
    out.push_back(std::move(r.choice));
  }
  return out;
}

int choose_pair_resolution(const Scene& scene, const PairRegions& regions, const View& view) {
  const Sample sample = draw(scene, regions);
  double least = 0;
  return best_resolution(sample, image_of(sample, view), least);
}

}  // namespace farcull
