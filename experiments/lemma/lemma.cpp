// Makes triangles that are hard cases for the lemmas, fattens and draws them. Compares the samples
// of each pixel, in exact arithmetic, with points of the triangles in the pixel.
#include "experiments/lemma/lemma.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/random.h"
#include "verify/exact_point.h"

namespace farcull {
namespace {

constexpr double kUsualDepth = 128;  // default of LemmaSettings::depth

using Random = RandomNumbers;
using Weights = std::array<int, 3>;  // barycentric coordinates of a point, not normalized

// A triangle in px, and points of the triangle to test. The origin is a pixel corner. run_round()
// divides the window into square cells, and moves the origin of each trial to the centre of a cell.
struct Trial {
  std::array<Vec3, 3> corners;
  std::vector<Weights> weights;
};

Vec3 in_ball(Random& random, double reach) {
  return {random.between(-reach, reach), random.between(-reach, reach),
          random.between(-reach, reach)};
}

std::vector<Weights> random_weights(Random& random, int count) {
  std::vector<Weights> out = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < count; ++i) {
    const int a = random.below(1025), b = random.below(1025 - a);
    out.push_back({a, b, 1024 - a - b});
  }
  return out;
}

// A short segment at 45 degrees in the image, with its middle at q. The segment's fattened box has
// a face that is parallel to the segment, one radius away from q.
Trial diagonal_segment(Random& random, const Vec3& q) {
  const Vec3 half(0x1p-14, 0x1p-14 * random.sign(), 0);
  return {{q - half, q + half, q + half}, {{1, 1, 0}}};
}

// Makes trials of one kind.
struct Generator {
  const char* name;
  bool large;  // true: trials of up to 24 px in cells of 128 px; false: tiny trials, cells of 6 px
  int side;    // side of the window in px; with the border, a power of two
  bool rim;    // true: only cells in the window's far corner
  Trial (*make)(Random&);
};

Trial corner(Random& random) {
  const double spread = std::exp2(random.between(-30, -9.5));
  return diagonal_segment(random, Vec3(random.between(-spread, spread),
                                       random.between(-spread, spread), random.between(-90, 90)));
}

Trial exact_corner(Random& random) {
  return diagonal_segment(random, Vec3(0, 0, random.between(-90, 90)));
}

Trial pixel_edge(Random& random) {
  Vec3 q(random.between(-0.5, 0.5), 0, random.between(-90, 90));
  if (random.below(2)) std::swap(q[0], q[1]);
  if (random.below(2)) q[1] += std::exp2(random.between(-40, -10)) * random.sign();
  return diagonal_segment(random, q);
}

Trial pixel_centre(Random& random) {
  Trial t{{Vec3(0.5, 0.5, random.between(-90, 90)), in_ball(random, 12), in_ball(random, 12)},
          random_weights(random, 60)};
  if (random.below(2)) t.corners[1] = t.corners[0] + Vec3(0, 0, random.between(-20, 20));
  return t;
}

Trial random_triangle(Random& random) {
  const double reach = std::exp2(random.between(-8, 4.5));
  return {{in_ball(random, reach), in_ball(random, reach), in_ball(random, reach)},
          random_weights(random, 120)};
}

// A triangle with two edges at 45 degrees and its corners at pixel corners.
Trial diagonal_triangle(Random& random) {
  const int n = 1 + random.below(10);
  const double s = random.sign();
  const Vec3 a(0, 0, random.between(-20, 20));
  return {
      {a, a + Vec3(n, s * n, random.between(-9, 9)), a + Vec3(s * n, -n, random.between(-9, 9))},
      random_weights(random, 120)};
}

// A triangle whose plane is parallel to the viewing direction, exactly or nearly.
Trial edge_on(Random& random) {
  const Vec3 a = in_ball(random, 10), b = in_ball(random, 10);
  Vec3 c = a + random.unit() * (b - a);
  c[2] = random.between(-24, 24);
  if (random.below(2)) c[0] += std::exp2(random.between(-50, -8));
  return {{a, b, c}, random_weights(random, 120)};
}

// A triangle almost parallel to the image: its normal is almost along the viewing direction.
Trial flat(Random& random) {
  Trial t = random_triangle(random);
  const double tilt = std::exp2(random.between(-45, -3));
  for (Vec3& c : t.corners) c[2] *= tilt;
  return t;
}

// A needle of aspect ratio 1e3 to 1e12. One in three is tilted towards the viewing direction.
Trial needle(Random& random) {
  Vec3 along = in_ball(random, 14);
  if (random.below(3) == 0) along.head<2>() *= std::exp2(random.between(-30, 0));
  const Vec3 across = in_ball(random, 1) * along.norm() * std::pow(10, -random.between(3, 12));
  const Vec3 at = in_ball(random, 4);
  return {{at - along, at + along, at + along * random.between(-1, 1) + across},
          random_weights(random, 120)};
}

Trial segment_or_point(Random& random) {
  const Vec3 a = in_ball(random, 10), b = random.below(4) ? in_ball(random, 10) : a;
  return {{a, b, random.below(2) ? a : b}, random_weights(random, 60)};
}

// A triangle nearly along the viewing direction. In the image its longest edge is at 45 degrees,
// and the middle of this edge is at a pixel corner. So the fattened box has, near a pixel centre, a
// face that is as steep as the edge. `lean` is a multiple of 2^-20 px, so that the middle is exact.
Trial steep_corner(Random& random) {
  const double lean = std::floor(std::exp2(random.between(-10, -1)) * 0x1p20) * 0x1p-20;
  const Vec3 q(0, 0, random.between(-20, 20));
  const double s = random.sign();
  const Vec3 half(lean, lean * s, std::exp2(random.between(0, 6.5)));
  const Vec3 aside = Vec3(1, s, 0) * random.sign() * 0x1p-12;
  return {{q - half, q + half, q + aside}, {{1, 1, 0}}};
}

constexpr Generator kGenerators[] = {{"pixel corners", false, 508, false, corner},
                                     {"exact pixel corners", false, 508, false, exact_corner},
                                     {"pixel corners at the rim", false, 4092, true, exact_corner},
                                     {"pixel edges", false, 508, false, pixel_edge},
                                     {"corner at a pixel centre", true, 764, false, pixel_centre},
                                     {"random triangles", true, 764, false, random_triangle},
                                     {"edges at 45 degrees", true, 764, false, diagonal_triangle},
                                     {"parallel to the view", true, 764, false, edge_on},
                                     {"almost flat", true, 764, false, flat},
                                     {"needles", true, 764, false, needle},
                                     {"segments and points", true, 764, false, segment_or_point},
                                     {"steep at pixel corners", false, 508, false, steep_corner}};

Window lab_window(int side, double depth) {
  const Vec3 half(0.5 * side, 0.5 * side, depth);
  return {.view = parse_view("z"),
          .origin = Vec3::Zero(),
          .map = Eigen::Matrix3d::Identity(),
          .pixel_size = 1,
          .width = side,
          .height = side,
          .lo = -half,
          .hi = half};
}

// Moves each corner by kMaxDoubleError along each axis. In half of the cases, one vector moves all
// corners, so that points move as far as possible. In the other half, each corner has its own
// vector, so that edges turn.
void displace(std::array<Vec3, 3>& corners, Random& random) {
  const bool turn = random.below(2) != 0;
  Vec3 by(0, 0, 0);
  for (Vec3& c : corners) {
    if (turn || by[0] == 0) by = Vec3(random.sign(), random.sign(), random.sign());
    c += by * kMaxDoubleError;
  }
}

// Returns depth_rounding(), also for 16 bits, in units of 2^-24. A 16-bit buffer errs by at most
// 1 / (2^16 - 1) when it stores a depth, and by at most 2^-24 when the depth is read as a float.
double rounding_of(int depth_bits) {
  return depth_bits == 16 ? 0.5 + 1 + 0x1p24 / (0x1p16 - 1) + 1 : depth_rounding(depth_bits);
}

// Compares a point with the samples of a pixel that contains the point. Counts errors in the row.
void count(const ExactPoint& point, float entry, float exit, const Window& window, int depth_bits,
           bool stored, LemmaRow& row) {
  ++row.points;
  if (stored ? entry == 1 || exit == 0 : std::isnan(entry) || std::isnan(exit)) {
    ++row.no_sample;
    return;
  }
  if (!std::isfinite(entry) || !std::isfinite(exit)) {  // a correct kernel returns finite numbers
    ++row.not_bounding;
    row.largest_steps = row.largest_px = HUGE_VAL;
    return;
  }
  const double step = depth_step(window, depth_bits);
  const double by = stored ? beyond_stored(point, entry, exit, depth_scale(window)) * 0x1p24
                           : beyond(point, entry, exit) / step;
  if (by <= 0) return;
  ++(stored && by <= rounding_of(depth_bits) ? row.rounded : row.not_bounding);
  row.largest_steps = std::max(row.largest_steps, by);
  row.largest_px = std::max(row.largest_px, by * step);
}

// Random numbers: `trials` for triangles, `lifts` for depths in windows deeper than kUsualDepth.
struct Streams {
  RandomNumbers trials;
  RandomNumbers lifts;
};

// Draws trials in one window, and adds their counts to the row.
void run_round(Canvas& canvas, const Fattener& fattener, const LemmaSettings& settings,
               const Generator& generator, Streams& random, std::uint64_t wanted, LemmaRow& row) {
  const int side = settings.side > 0 ? settings.side : generator.side;
  const Window window = lab_window(side, settings.depth);
  const Budget budget = budget_for(canvas.limits(), viewport_side(side));
  const int depth_bits = canvas.limits().depth_bits;
  const double radius = settings.radius(budget, depth_step(window, depth_bits));
  const ProxyBounds bounds = proxy_bounds(window);
  const int cell = generator.large ? 128 : 6;
  const int first = generator.rim ? side / 2 - std::min(20 * cell, side) : -side / 2;
  Drawables drawables;
  drawables.mode = fattener.mode;
  std::vector<ExactPoint> points;
  for (int y = first; y + cell <= side / 2; y += cell) {
    for (int x = first; x + cell <= side / 2; x += cell) {
      if (row.points + points.size() >= wanted) continue;
      Trial trial = generator.make(random.trials);
      const double lift = (settings.depth - kUsualDepth) * random.lifts.between(-1, 1);
      const Vec3 centre(x + cell / 2, y + cell / 2, lift);
      for (Vec3& c : trial.corners) c += centre;
      for (const auto& weights : trial.weights) points.push_back({trial.corners, weights});
      Patch patch;
      patch.count = 3;
      if (settings.displace) displace(trial.corners, random.trials);
      std::copy_n(trial.corners.begin(), 3, patch.corners.begin());
      fattener.fatten(patch, radius, bounds, drawables);
      drawables.first.push_back(static_cast<std::uint32_t>(drawables.elements()));
    }
  }
  std::vector<Draw> draws;
  for (std::uint32_t e = 0; e < drawables.elements(); ++e) draws.push_back({e, 0});
  canvas.begin(window, drawables);
  const auto read = [&](Verb verb) {
    return settings.stored ? canvas.depths(verb, draws) : canvas.samples(verb, draws);
  };
  const std::vector<float> entries = read(Verb::store), exits = read(Verb::ask);
  for (const ExactPoint& point : points) {
    for (const Pixel& pixel : pixels_containing(point, window.width, window.height)) {
      const std::size_t at = static_cast<std::size_t>(pixel.y) * window.width + pixel.x;
      count(point, entries[at], exits[at], window, depth_bits, settings.stored, row);
    }
  }
}

}  // namespace

std::vector<std::string> lemma_generators() {
  std::vector<std::string> out;
  for (const Generator& generator : kGenerators) out.push_back(generator.name);
  return out;
}

std::vector<LemmaRow> lemma_experiment(Canvas& canvas, const Fattener& fattener,
                                       const LemmaSettings& settings, const Progress& progress) {
  if (!settings.generator.empty() &&
      std::ranges::count(lemma_generators(), settings.generator) == 0) {
    throw std::logic_error("lemma_experiment: no generator " + settings.generator);
  }
  std::vector<LemmaRow> rows;
  std::uint64_t index = 0;
  const std::uint64_t each =
      (settings.points + std::size(kGenerators) - 1) / std::size(kGenerators);
  for (const Generator& generator : kGenerators) {
    const std::uint64_t seed = settings.seed * 1000003 + index++;
    if (!settings.generator.empty() && settings.generator != generator.name) continue;
    LemmaRow row{.generator = generator.name};
    Streams random{RandomNumbers(seed), RandomNumbers(~seed)};
    while (row.points < each) {
      if (progress) progress(fmt::format("{}: {} of {} points", row.generator, row.points, each));
      run_round(canvas, fattener, settings, generator, random, each, row);
    }
    rows.push_back(row);
  }
  return rows;
}

double lemma_radius(const RadiusRule& rule, const Budget& budget, double depth_step) {
  return rule.published ? published_radius(depth_step) : rule.factor * budget.radius();
}

LemmaRow lemma_total(const std::vector<LemmaRow>& rows) {
  LemmaRow total{.generator = "all"};
  for (const LemmaRow& row : rows) {
    total.points += row.points;
    total.no_sample += row.no_sample;
    total.not_bounding += row.not_bounding;
    total.rounded += row.rounded;
    total.largest_px = std::max(total.largest_px, row.largest_px);
    total.largest_steps = std::max(total.largest_steps, row.largest_steps);
  }
  return total;
}

}  // namespace farcull
