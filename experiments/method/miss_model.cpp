// Predicts how many pairs a method that draws misses. In each view, triangle B hides a polygon of
// triangle A: the common part of both images, cut at the line where the planes have equal depths. A
// view keeps a triangle if a pixel centre lies in a hidden part of the triangle. The probability of
// this event follows from the area, the width and the height of the part. A pair is found if every
// view keeps both triangles.
#include "experiments/method/miss_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/native/canvas.h"
#include "core/view/budget.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr std::size_t kMostParts = std::size_t{1} << 22;  // largest number of parts in a view
// The largest number of rounds in solve() if the options set no limit. Ten rounds usually suffice.
// Tens of rounds are needed if each culled triangle uncovers the next triangle.
constexpr int kMostRepeats = 200;
// Standard deviation (px) of the change that snapping makes to a triangle's height over its longest
// edge. Snapping moves corners to multiples of 2^-b px (b: kNativeSubpixelBits). So the error along
// each axis has the variance 4^-b / 12. The variance of the height is 5/3 times as large,
// averaged over the positions of the height's foot.
const double kSnapped = std::sqrt(5.0 / 36) / (1 << kNativeSubpixelBits);

struct Point2 {
  double x = 0, y = 0;
};

struct Range {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  void add(double x) {
    lo = std::min(lo, x);
    hi = std::max(hi, x);
  }
  void add(const Range& other) {
    lo = std::min(lo, other.lo);
    hi = std::max(hi, other.hi);
  }
  double size() const { return std::max(hi - lo, 0.0); }
};

struct Polygon {
  std::vector<Point2> points;  // counterclockwise

  double area() const {
    double sum = 0;
    for (std::size_t i = 2; i < points.size(); ++i) {
      const Point2 &o = points[0], &p = points[i - 1], &q = points[i];
      sum += (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
    }
    return 0.5 * sum;
  }
  Range along(const Point2& axis) const {
    Range out;
    for (const Point2& p : points) out.add(axis.x * p.x + axis.y * p.y);
    return out;
  }
  // Keeps the part where a x + b y + c >= 0.
  void cut(double a, double b, double c) {
    static thread_local std::vector<Point2> kept;
    kept.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point2 &p = points[i], &q = points[i + 1 < points.size() ? i + 1 : 0];
      const double at_p = a * p.x + b * p.y + c, at_q = a * q.x + b * q.y + c;
      if (at_p >= 0) kept.push_back(p);
      if ((at_p >= 0) != (at_q >= 0)) {
        const double t = at_p / (at_p - at_q);
        kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
      }
    }
    points.swap(kept);
  }
};

Polygon hull(std::vector<Point2> of) {
  std::ranges::sort(
      of, [](const Point2& p, const Point2& q) { return p.x < q.x || (p.x == q.x && p.y < q.y); });
  std::vector<Point2> out;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t first = out.size();
    for (auto p = begin; p != end; ++p) {
      while (out.size() >= first + 2) {
        const Point2 &a = out[out.size() - 2], &b = out.back();
        if ((b.x - a.x) * (p->y - a.y) - (b.y - a.y) * (p->x - a.x) > 0) break;
        out.pop_back();
      }
      out.push_back(*p);
    }
    out.pop_back();
  };
  add_chain(of.begin(), of.end());
  add_chain(of.rbegin(), of.rend());
  return {std::move(out)};
}

// Returns the sizes of an image along two axes in which both sizes are small. Axes with integer
// components and the determinant 1 map pixel centres to pixel centres. So the probability that the
// image contains a centre is the same in all such axes. In suitable axes, a needle in the direction
// (2, 3) is a narrow strip. Lagrange's reduction, applied to the moments of the corners, finds
// suitable axes. The reduction ends if the longer size is at most 1 px. Then the area is the
// smallest bound on this probability.
std::array<double, 2> compact_sizes(const Polygon& image) {
  Point2 a{1, 0}, b{0, 1};
  while (true) {
    Range at_a = image.along(a), at_b = image.along(b);
    if (at_a.size() > at_b.size()) {
      std::swap(a, b);
      std::swap(at_a, at_b);
    }
    double aa = 0, ab = 0;
    for (const Point2& p : image.points) {
      const double to_a = a.x * p.x + a.y * p.y - 0.5 * (at_a.lo + at_a.hi);
      aa += to_a * to_a;
      ab += to_a * (b.x * p.x + b.y * p.y - 0.5 * (at_b.lo + at_b.hi));
    }
    const double steps = aa > 0 ? std::round(ab / aa) : 0;
    const Point2 next{b.x - steps * a.x, b.y - steps * a.y};
    if (at_b.size() <= 1 || image.along(next).size() >= at_b.size())
      return {at_a.size(), at_b.size()};
    b = next;
  }
}

// The image of a drawn triangle, fattened by a disc if the method fattens triangles.
struct Image {
  Polygon polygon;  // empty: not drawn, or seen edge-on
  double area = 0;
  Range x, y, depth;
  std::array<double, 2> compact = {};            // compact_sizes()
  double drawn = 0;                              // probability that the image contains a centre
  double slope_x = 0, slope_y = 0, depth_0 = 0;  // depth = depth_0 + slope_x * x + slope_y * y
  double slant = 0;    // px that the depth changes if the plane moves by 1 px along its normal
  double snapped = 1;  // factor by which snapping changes the expected area of a thin image
};

// Returns the expected value of |w + s N| / w, for w = width, s = kSnapped and a standard normal N.
double snapped_share(double width) {
  const double z = width / kSnapped;
  if (z > 10) return 1;
  return std::sqrt(2 / std::numbers::pi) * std::exp(-0.5 * z * z) / z +
         std::erf(z / std::numbers::sqrt2);
}

// Returns the rectangle that encloses a flat polygon and is parallel to the polygon's longest edge.
// The rectangle is the image of an oriented box.
std::vector<Vec3> rectangle(std::span<const Vec3> points, const Vec3& normal) {
  Vec3 along = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 edge = points[(i + 1) % points.size()] - points[i];
    if (edge.squaredNorm() > along.squaredNorm()) along = edge;
  }
  along.normalize();
  const Vec3 across = normal.cross(along).normalized();
  Range u, v;
  for (const Vec3& p : points) {
    u.add(along.dot(p - points[0]));
    v.add(across.dot(p - points[0]));
  }
  std::vector<Vec3> out;
  for (const auto& [s, t] : {std::pair(u.lo, v.lo), {u.hi, v.lo}, {u.hi, v.hi}, {u.lo, v.hi}})
    out.push_back(points[0] + s * along + t * across);
  return out;
}

Image image_of(const Window& window, const std::array<Vec3, 3>& corners, double radius, bool box) {
  Image out;
  const Patch patch = clip_to_region(window, corners);
  if (!patch.drawable() || patch.count < 3) return out;
  const Vec3 origin = to_pixel(window, corners[0]).p;
  const Vec3 normal =
      (to_pixel(window, corners[1]).p - origin).cross(to_pixel(window, corners[2]).p - origin);
  if (normal.z() == 0) return out;
  out.slope_x = -normal.x() / normal.z();
  out.slope_y = -normal.y() / normal.z();
  out.depth_0 = origin.z() - out.slope_x * origin.x() - out.slope_y * origin.y();
  out.slant = std::sqrt(1 + out.slope_x * out.slope_x + out.slope_y * out.slope_y);
  std::vector<Vec3> points(patch.points().begin(), patch.points().end());
  if (box) points = rectangle(points, normal);
  std::vector<Point2> flat;
  double longest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    out.depth.add(points[i].z());
    longest = std::max(longest, (points[(i + 1) % points.size()] - points[i]).head<2>().norm());
    if (radius == 0) flat.push_back({points[i].x(), points[i].y()});
    for (int k = 0; radius > 0 && k < 8; ++k) {  // an octagon with the area of the disc
      const double angle = (k + 0.5) * std::numbers::pi / 4, reach = 1.0540 * radius;
      flat.push_back(
          {points[i].x() + reach * std::cos(angle), points[i].y() + reach * std::sin(angle)});
    }
  }
  out.polygon = hull(std::move(flat));
  out.area = out.polygon.area();
  if (out.polygon.points.size() < 3 || !(out.area > 0)) return {};
  out.x = out.polygon.along({1, 0});
  out.y = out.polygon.along({0, 1});
  out.compact = compact_sizes(out.polygon);
  if (radius == 0 && !box) out.snapped = snapped_share(2 * out.area / longest);
  out.area *= out.snapped;
  return out;
}

// The part of triangle `of` that triangle `by` hides. Parts that overlap along one axis form a
// place (find_places()).
struct Part {
  std::uint32_t of = 0, by = 0;
  double share = 0;  // area of the part / area of the image of `of` in its place
  Range x, y;
  double place = 0;  // area of the image in the place; 0 except in the place's first part
  double strip = 0, width = 0, height = 0;  // region where each hides the other: area, sides
};

struct ViewOfParts {
  std::vector<Image> images;         // one per triangle, without polygons
  std::vector<std::uint32_t> first;  // each triangle's first index in parts; last: parts.size()
  std::vector<Part> parts;           // sorted by triangle, then by place
  double radius = 0;                 // radius of the ball in px
};

// Adds the part of `back` that `front` hides. `front` may be up to `near` behind `back`.
void add_part(const Polygon& common, const Image& back, const Image& front, double thick,
              double near, std::uint32_t of, std::uint32_t by, std::vector<Part>& out) {
  if (back.depth.hi + near < front.depth.lo) return;
  const double a = back.slope_x - front.slope_x, b = back.slope_y - front.slope_y,
               c = back.depth_0 - front.depth_0;
  Polygon hidden = common;
  if (back.depth.lo + near < front.depth.hi) hidden.cut(a, b, c + near);
  if (hidden.points.size() < 3) return;
  const double area = hidden.area() * back.snapped * front.snapped;
  if (!(area > 0)) return;
  Part part{
      .of = of, .by = by, .share = area, .x = hidden.along({1, 0}), .y = hidden.along({0, 1})};
  if (thick > 0) {
    hidden.cut(-a, -b, near - c);
    part.strip = hidden.area();
    part.width = hidden.along({1, 0}).size();
    part.height = hidden.along({0, 1}).size();
  }
  out.push_back(part);
}

// Groups the parts of one triangle into places. Along the longer side of the triangle's image, a
// new place begins after each gap between parts.
void find_places(const Image& image, std::span<Part> parts) {
  Range Part::*const side = image.x.size() > image.y.size() ? &Part::x : &Part::y;
  std::ranges::sort(parts, {}, [&](const Part& p) { return std::pair((p.*side).lo, p.by); });
  for (std::size_t i = 0, end = 0; i < parts.size(); i = end) {
    Part around;
    for (end = i; end < parts.size(); ++end) {
      if (end > i && (parts[end].*side).lo > (around.*side).hi) break;
      around.x.add(parts[end].x);
      around.y.add(parts[end].y);
    }
    Polygon place = image.polygon;
    place.cut(1, 0, -around.x.lo);
    place.cut(-1, 0, around.x.hi);
    place.cut(0, 1, -around.y.lo);
    place.cut(0, -1, around.y.hi);
    double most = 0;  // largest area of a part
    for (std::size_t k = i; k < end; ++k) most = std::max(most, parts[k].share);
    parts[i].place = std::max(place.area() * image.snapped, most);
    for (std::size_t k = i; k < end; ++k)
      parts[k].share = std::min(parts[k].share / parts[i].place, 1 - 1e-6);
  }
}

// Finds all parts in a view. Returns false if there are too many parts.
bool find_parts(const Scene& scene, const DrawPlan& work, const Window& window, double radius,
                bool box, ViewOfParts& out) {
  const std::vector<std::uint32_t> owner = owners(scene);
  out.radius = radius;
  out.images.resize(scene.triangles.size());
  std::vector<std::uint32_t> order;
  for (const std::uint32_t t : work.regions.triangles) {
    out.images[t] = image_of(window, scene.corners(t), radius, box);
    if (out.images[t].area > 0) order.push_back(t);
  }
  const auto left = [&](std::uint32_t t) { return out.images[t].x.lo; };
  std::ranges::sort(order, {}, left);
  // Depths within half a step round to the same float. A triangle also hides others at equal depth.
  const double step = 0.5 * depth_step(window, 32);
  Polygon common;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t s = order[i];
    const Image& a = out.images[s];
    for (std::size_t j = i + 1; j < order.size() && left(order[j]) <= a.x.hi; ++j) {
      const std::uint32_t t = order[j];
      const Image& b = out.images[t];
      if (owner[s] == owner[t] || b.y.lo > a.y.hi || b.y.hi < a.y.lo) continue;
      common = a.polygon;
      const std::vector<Point2>& corners = b.polygon.points;
      for (std::size_t k = 0; k < corners.size() && !common.points.empty(); ++k) {
        const Point2 &p = corners[k], &q = corners[k + 1 < corners.size() ? k + 1 : 0];
        common.cut(p.y - q.y, q.x - p.x, (q.y - p.y) * p.x - (q.x - p.x) * p.y);
      }
      if (common.points.size() < 3) continue;
      const double thick = radius * (a.slant + b.slant);
      add_part(common, a, b, thick, step + thick, s, t, out.parts);
      add_part(common, b, a, thick, step + thick, t, s, out.parts);
      if (out.parts.size() > kMostParts) return false;
    }
  }
  std::ranges::sort(out.parts, {}, &Part::of);
  out.first.assign(scene.triangles.size() + 1, 0);
  for (const Part& part : out.parts) ++out.first[part.of + 1];
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    out.first[t + 1] += out.first[t];
    find_places(out.images[t],
                std::span(out.parts).subspan(out.first[t], out.first[t + 1] - out.first[t]));
  }
  for (Image& image : out.images) image.polygon = {};
  return true;
}

// Returns the share of a pixel's square that a disc around the pixel's centre covers.
double disc_share(double radius) {
  if (radius >= std::numbers::sqrt2 / 2) return 1;
  const double whole = std::numbers::pi * radius * radius;
  if (radius <= 0.5) return whole;
  return whole -
         4 * (radius * radius * std::acos(0.5 / radius) - 0.5 * std::sqrt(radius * radius - 0.25));
}

// Solves the equations for the probabilities that triangles are kept.
class Equations {
 public:
  Equations(const Scene& scene, std::vector<ViewOfParts> views, const CullSettings& settings,
            double sharpness)
      : owner_(owners(scene)),
        views_(std::move(views)),
        settings_(settings),
        sharpness_(sharpness) {
    const std::size_t n = scene.triangles.size();
    for (auto& keep : now_) keep.assign(n, 1);
    for (ViewOfParts& view : views_) {
      for (Image& image : view.images)
        image.drawn = centre_probability(image.area, image.compact[0], image.compact[1],
                                         view.radius, sharpness_);
    }
  }

  void solve() {
    const bool any = settings_.clear == ClearRule::any;
    before_.assign(views_.size(), now_);
    for (std::size_t v = 0; any && v < views_.size(); ++v) {  // the first round
      before_[v] = now_;
      State next = now_;
      for_all([&](int side, std::uint32_t t) { next[side][t] *= seen(v, t, side); });
      now_ = std::move(next);
    }
    if (settings_.rounds == 1) {
      if (!any) now_ = after_round();
      return;
    }
    const int repeats = settings_.rounds > 0 ? settings_.rounds - any : kMostRepeats;
    for (int k = 0; k < repeats; ++k) {
      const State next = after_round();
      double change = 0;
      for_all([&](int side, std::uint32_t t) {
        change += std::max(now_[side][t] - next[side][t], 0.0);
        now_[side][t] = std::min(now_[side][t], next[side][t]);
      });
      if (change < 1e-3) break;
    }
    before_.assign(views_.size(), now_);
  }

  // Returns the probability that a triangle is kept.
  double kept(std::uint32_t t) const {
    return settings_.quick ? 1 - (1 - now_[0][t]) * (1 - now_[1][t]) : now_[0][t];
  }

  // Returns the probability that a pair is found.
  double found(TrianglePair pair) {
    if (owner_[pair.a] > owner_[pair.b]) std::swap(pair.a, pair.b);
    const auto& [a, b] = pair;
    const int second = sides() - 1, first = 0;
    double each = 1, a_cleared = 1, b_cleared = 1;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      now_.swap(before_[v]);
      const double at_a = seen(v, a, second, b), at_b = seen(v, b, first, a);
      const double both = std::min({both_seen(v, a, b), at_a, at_b});
      now_.swap(before_[v]);
      each *= both < 1 ? both + (at_a - both) * (at_b - both) / (1 - both) : 1;
      a_cleared *= 1 - at_a;
      b_cleared *= 1 - at_b;
    }
    if (settings_.clear == ClearRule::all) each = (1 - a_cleared) * (1 - b_cleared);
    if (!settings_.quick) return each;
    return each + (1 - each) * now_[0][a] * now_[1][b];  // other triangles may keep a and b
  }

 private:
  // State[side][triangle] is the probability that the triangle is not cleared. Plain CULLIDE has
  // one side. Quick-CULLIDE has two sides: side 0 tests against earlier owners (bit F), side 1
  // against later owners (bit L).
  using State = std::array<std::vector<double>, 2>;

  int sides() const { return settings_.quick ? 2 : 1; }

  template <class Visit>
  void for_all(const Visit& visit) const {
    for (int side = 0; side < sides(); ++side) {
      for (std::uint32_t t = 0; t < owner_.size(); ++t) visit(side, t);
    }
  }

  State after_round() const {
    State next = now_;
    for_all([&](int side, std::uint32_t t) {
      double kept = 1, cleared = 1;
      for (std::size_t v = 0; v < views_.size(); ++v) {
        const double p = seen(v, t, side);
        kept *= p;
        cleared *= 1 - p;
      }
      next[side][t] = settings_.clear == ClearRule::any ? kept : 1 - cleared;
    });
    return next;
  }

  // Returns the probability that triangle part.by is still in the depth buffer.
  double stored(const Part& part, int side) const {
    if (!settings_.quick) return now_[0][part.by];
    return (owner_[part.by] < owner_[part.of]) == (side == 0) ? now_[1 - side][part.by] : 0;
  }

  // Returns the probability that a view does not clear triangle t. surely: a triangle that is in
  // the depth buffer with probability 1.
  double seen(std::size_t v, std::uint32_t t, int side, std::uint32_t surely = UINT32_MAX) const {
    const ViewOfParts& view = views_[v];
    double none = 1;  // probability that no place contains a pixel centre
    double open = 0;  // logarithm of the share of the place that nothing hides
    double place = 0;
    Range x, y;
    for (std::uint32_t i = view.first[t]; i < view.first[t + 1]; ++i) {
      const Part& part = view.parts[i];
      if (part.place > 0) {
        place = part.place;
        x = y = {};
        open = 0;
      }
      const double p = part.by == surely ? 1 : stored(part, side);
      open += std::log1p(-p * part.share);
      if (p >= 0.05) {  // an unlikely part must not extend x and y
        x.add(part.x);
        y.add(part.y);
      }
      if (i + 1 < view.first[t + 1] && !(view.parts[i + 1].place > 0)) continue;
      if (!(open < 0)) continue;
      const double hidden = -place * std::expm1(open);
      none *= 1 - centre_probability(hidden, x.size(), y.size(), view.radius, sharpness_);
    }
    return std::min(1 - none, view.images[t].drawn);
  }

  // Returns the probability that the same pixel centre keeps both a and b. This is possible, since
  // fattened triangles can hide each other.
  double both_seen(std::size_t v, std::uint32_t a, std::uint32_t b) const {
    const ViewOfParts& view = views_[v];
    if (!(view.radius > 0)) return 0;
    const auto end = view.parts.begin() + view.first[a + 1];
    const auto part = std::find_if(view.parts.begin() + view.first[a], end,
                                   [&](const Part& p) { return p.by == b; });
    if (part == end || !(part->strip > 0)) return 0;
    return centre_probability(part->strip, part->width, part->height, view.radius, sharpness_);
  }

  std::vector<std::uint32_t> owner_;
  std::vector<ViewOfParts> views_;
  const CullSettings& settings_;
  const double sharpness_;
  State now_;
  std::vector<State> before_;  // one per view: the state when the view is drawn
};

}  // namespace

// The model is assumed to err by at most a factor of 1.2 in the number of missed pairs, and of 1.5
// in the number of found pairs. low() and high() use the tighter of the two bounds.
double MissPrediction::low() const {
  const auto all = static_cast<double>(colliding);
  return std::max(std::max(missed / 1.2, all - 1.5 * (all - missed)) - 2 * deviation, 0.0);
}
double MissPrediction::high() const {
  const auto all = static_cast<double>(colliding);
  return std::min(std::min(missed * 1.2, all - (all - missed) / 1.5) + 2 * deviation, all);
}

double centre_probability(double area, double width, double height, double radius,
                          double sharpness) {
  // The area, the width and the height are upper bounds of the probability. A disc in the region
  // contains a centre with probability `disc`. If the disc contains none, the same bounds hold for
  // the region without the disc, divided by the probability `rest` of this case.
  const double disc = disc_share(radius), rest = 1 - disc;
  if (rest <= 0) return 1;
  const auto term = [&](double size) { return std::pow(std::max(size / rest, 1e-12), -sharpness); };
  const double sum = 1 + term(area - std::numbers::pi * radius * radius) +
                     term(std::max(width, 2 * radius) - disc) +
                     term(std::max(height, 2 * radius) - disc);
  return disc + rest * std::pow(sum, -1 / sharpness);
}

std::string why_unpredicted(const RunOptions& options) {
  if (!has_broad_phase(options.method))
    return "the method does not draw objects against each other";
  if (guaranteed(options)) return "the method misses nothing";
  if (options.conservative) return "conservative rasterization";
  if (options.objects_alone) return "objects are culled as a whole";
  if (options.radius.published) return "the published radius";
  if (fattens(options.method) && depth_of(options) == DepthMode::fixed)
    return "boxes drawn as surfaces";
  return "";
}

MissesOfPlan misses_of(const Scene& scene, const Plan& plan) {
  const auto* work = std::get_if<DrawPlan>(&plan.work);
  if (work == nullptr || guaranteed(plan.options)) return {};
  MissesOfPlan out;
  out.why_not =
      has_self(scene) ? "objects are tested against themselves" : why_unpredicted(plan.options);
  if (!out.why_not.empty()) return out;
  const ExactResult exact = all_colliding_pairs(scene, {}, plan.options.ignored);
  out.predicted = predict_misses(scene, *work, plan.options, exact.pairs);
  if (!out.predicted) out.why_not = "the images of too many triangles overlap";
  return out;
}

std::string misses_line(const MissesOfPlan& misses) {
  constexpr const char* kName = "misses     ";
  if (!misses.why_not.empty()) return kName + ("not predicted: " + misses.why_not) + "\n";
  if (!misses.predicted) return "";
  const MissPrediction& of = *misses.predicted;
  const auto whole = [](double x) { return std::to_string(std::llround(x)); };
  return kName + whole(of.missed) + " of " + std::to_string(of.colliding) +
         " colliding pairs expected, " + whole(of.low()) + " to " + whole(of.high()) +
         (of.judged() ? "\n" : "; the range is not reliable above 40 %\n");
}

std::optional<MissPrediction> predict_misses(const Scene& scene, const DrawPlan& work,
                                             const RunOptions& options,
                                             std::span<const TrianglePair> colliding,
                                             double sharpness) {
  const bool fat = fattens(options.method);
  MissPrediction out{.colliding = colliding.size()};
  std::vector<ViewOfParts> views;
  for (const View& view : work.settings.views) {
    if (work.regions.places.empty()) break;
    const auto window = fit_window(view, work.regions.places, work.settings.resolution);
    if (!window && work.settings.clear == ClearRule::all) return out;  // nothing is culled
    if (!window) continue;                                             // this view clears nothing
    const int side = viewport_side(std::max(window->width, window->height));
    const double radius =
        fat ? options.radius.factor * budget_for(native_limits(32), side).radius() : 0;
    if (!find_parts(scene, work, *window, radius, fat && options.offset == "obb",
                    views.emplace_back()))
      return std::nullopt;
  }
  if (views.empty()) return out;
  Equations equations(scene, std::move(views), work.settings, sharpness);
  equations.solve();
  struct PairsOf {
    double sum = 0, squares = 0, most = 0;  // of the probabilities that its pairs are found
  };
  std::vector<PairsOf> triangles(scene.triangles.size());
  double variance = 0;
  for (const TrianglePair& pair : colliding) {
    const double found = equations.found(pair);
    out.missed += 1 - found;
    variance += found * (1 - found);
    for (PairsOf* const own : {&triangles[pair.a], &triangles[pair.b]})
      *own = {own->sum + found, own->squares + found * found, std::max(own->most, found)};
  }
  // A culled triangle loses all its pairs. So two pairs of a triangle that is kept with the
  // probability k are both found with the probability p q / k if they are found with p and q.
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto& [sum, squares, most] = triangles[t];
    const double kept = std::max(equations.kept(t), most);
    if (kept > 0) variance += (sum * sum - squares) * (1 - kept) / kept;
  }
  out.deviation = std::sqrt(variance);
  return out;
}

}  // namespace farcull
